; Goes down to the packet in which the ray is just behind its exit plane (or in which it starts: exit_axis = 3, exit_run = 0,
; exit_slope = 1). At a split s of axis j the point's coordinate O_j + D_j run / slope is compared with s as products,
; (s - O_j) slope with D_j run: exact, and the same for all three axes.
;
; The first time the walk starts at the root. Where it takes the near side of a split that the ray has still to cross, it notes the far
; side: the next packet behind that plane lies there, and the walk goes on from the last note on the exit axis instead of the root.
;
; In: origin, direction, backwards, exit_*, fars (the last note on each axis, 0 for none). Out: packet_count, packet_refs, box_low,
;-; box_high, fars. Returns by link_step. Scratch: s12 to s15, far_top, w0, w1.
; box_high, fars. Returns by link_step. Scratch: s12 to s15, far_top, w2 to w4. ;+

; Notes the far side of the node: s14 = its address, s12 = the axis.
.macro note_far
    sw    s14, far.node(far_top)
    note_box
    sv    fars, far.fars(far_top)
    vputr fars, far_top, s12
    lea   far_top, sizeof(far)(far_top)
.endm

.func descend
;-    vget  s12, direction, x
;-    .holds s12, dir
;-    wmul  w0, exit_run, s12
;-    swide w0, RUNS(s0)
;-    vget  s12, direction, y
;-    wmul  w0, exit_run, s12
;-    swide w0, RUNS + 8(s0)
;-    vget  s12, direction, z
;-    wmul  w0, exit_run, s12
;-    swide w0, RUNS + 16(s0)
    vget  s12, direction, x ;+
    wmul  w2, exit_run, s12 ;+
    vget  s12, direction, y ;+
    wmul  w3, exit_run, s12 ;+
    vget  s12, direction, z ;+
    wmul  w4, exit_run, s12 ;+
    vgetr far_top, fars, exit_axis
    bnez  far_top, descend_far
    vmov  fars, zero_vector
    movi  far_top, FARS
    first_node
descend_node:
    .holds s12
    .holds s14
    next_node descend_leaf
;-    .holds s15, pos
;-    vgetr s14, origin, s12
;-    .holds s14, pos
;-    sub   s14, s15, s14
;-    wmul  w0, s14, exit_slope
;-    slli  s14, s12, 3
;-    .holds s14
;-    lwide w1, RUNS(s14)
;-    bwlt  w0, w1, descend_right
;-    bweq  w0, w1, descend_tie
    mov   s14, s15 ;+
    kdside s14, s12, origin, w2, exit_slope ;+
    bgtz  s14, descend_right ;+
    bltz  s14, descend_tie ;+
descend_left:
    srl   s14, backwards, s12
    andi  s14, s14, 1
    bnez  s14, 1f
    right_child
    note_far
1:  go_left
    jump  descend_node
descend_right:
    srl   s14, backwards, s12
    andi  s14, s14, 1
    beqz  s14, 1f
    left_child
    note_far
1:  go_right
    jump  descend_node
descend_far:
    lv    fars, far.fars(far_top)
    lw    s13, far.node(far_top)
    far_node
    jump  descend_node
descend_tie:
    ; A plane through the origin and the exit plane itself are crossed. Of the split and the exit plane, met at the same t, the split
    ; is crossed when it is the first: for j < k when D_j > 0, for j > k when D_k < 0. A crossed plane lies behind: D_j >= 0 goes right.
    srl   s14, backwards, s12
    andi  s14, s14, 1
    vgetr exit_plane, origin, s12
    beq   s15, exit_plane, descend_crossed
    beq   s12, exit_axis, descend_crossed
    blt   s12, exit_axis, descend_lower
    srl   exit_plane, backwards, exit_axis
    andi  exit_plane, exit_plane, 1
    bnez  exit_plane, descend_crossed
    jump  descend_ahead
descend_lower:
    beqz  s14, descend_crossed
descend_ahead:
    bnez  s14, descend_right
    jump  descend_left
descend_crossed:
    beqz  s14, descend_right
    jump  descend_left
descend_leaf:
    leaf_packet
    ret   link_step
.endfunc
