; The first packet of a ray that may start outside the scene's box, or packet_count = -1 when it misses the box: the last of the planes
; that it enters by must come before the first that it leaves by. Compared as products, without division. Report, pseudo code 4.
; In: origin, direction. Out: steep, backwards, the packet and its box. Returns by link_packet.
; Scratch: v6 to v12, s12 to s15, w0, w1.
.func first_packet
    vabs  steep, direction
    vlt   backwards, direction, zero_vector
    lv    v6, ROOT_LOW(s0)
    .holds v6, pos
    lv    v7, ROOT_HIGH(s0)
    .holds v7, pos
    vmov  v8, v6
    .holds v8, pos
    vselect v8, v7, backwards               ; planes to enter by
    vselect v7, v6, backwards               ; planes to leave by
    vsub  v10, v8, origin
    .holds v10, pos
    vneg  v11, v10
    .holds v11, pos
    vselect v10, v11, backwards             ; how far ahead they are
    vsub  v12, v7, origin
    .holds v12, pos
    vneg  v11, v12
    vselect v12, v11, backwards
    vlt   s12, zero_vector, v12
    movi  s13, 7
    bne   s12, s13, first_missed            ; behind the origin, or beside the box
    movi  exit_axis, 3
    mov   exit_run, s0
    movi  exit_slope, 1
    .rept 3, k
    vget  s12, v10, k
    .holds s12, pos
    blez  s12, 2f
    vget  s13, steep, k
    .holds s13, dir
    beqz  s13, first_missed
    wmul  w0, s12, exit_slope
    wmul  w1, exit_run, s13
    bwlt  w0, w1, 2f
    bwlt  w1, w0, 1f
    srl   s14, backwards, exit_axis         ; met together: the lower axis is the later one when its direction is negative
    andi  s14, s14, 1
    bnez  s14, 2f
1:  movi  exit_axis, k
    mov   exit_run, s12
    mov   exit_slope, s13
2:
    .endr
    .rept 3, k
    vget  s12, v12, k
    vget  s13, steep, k
    wmul  w0, exit_run, s13
    wmul  w1, s12, exit_slope
    bwlt  w0, w1, 1f
    jump  first_missed
1:
    .endr
    vmov  fars, zero_vector
    call  link_step, descend
    ret   link_packet
first_missed:
.if SKIP_MISSED
    movi  packet_count, -1
.else
    ; A packet is searched all the same, and left as if by the scene's box.
    movi  exit_axis, 3
    mov   exit_run, s0
    movi  exit_slope, 1
    vmov  fars, zero_vector
    call  link_step, descend
    lv    box_low, ROOT_LOW(s0)
    lv    box_high, ROOT_HIGH(s0)
.endif
    ret   link_packet
.endfunc
