; The packet after the current one, or packet_count = -1 when the search is over: the ray leaves the scene, any hit will do and there
; is one, or the nearest hit is nearer than the exit. Pseudo code 2 says "within the limits" where it means on them, and pseudo code 3
; stops at the first packet with a hit, which may lie in a later one.
; In: the ray, the packet's box, near, near_t, any_hit. Out: the packet and its box. Returns by link_packet.
.func next_packet
    .holds exit_t, t
.if SKIP_ANY_HIT
    beqz  any_hit, 1f
    bnez  near, 4f
1:
.endif
    call  link_step, exit_face
.if SKIP_BEYOND
    bnez  any_hit, 2f
    beqz  near, 3f
2:  blt   near_t, exit_t, 4f
3:
.endif
    lv    v6, ROOT_HIGH(s0)
    .holds v6, pos
    vgetr s12, direction, exit_axis
    .holds s12, dir
    bgez  s12, 5f
    lv    v6, ROOT_LOW(s0)
5:  vgetr s12, v6, exit_axis
    .holds s12, pos
    beq   s12, exit_plane, 4f
    isubi steps, steps, 1
    beqz  steps, 6f
    call  link_step, descend
    ret   link_packet
4:  movi  packet_count, -1
    ret   link_packet
6:  trap  TRAP_STUCK
.endfunc
