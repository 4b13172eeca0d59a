; The packet in which a ray starts that starts inside the scene's box. In: origin, direction. Out: backwards, the packet and its box.
; Returns by link_packet.
.func own_packet
    vlt   backwards, direction, zero_vector
    .holds exit_run, pos
    .holds exit_slope, dir
    movi  exit_axis, 3
    mov   exit_run, s0
    movi  exit_slope, 1
    call  link_step, descend
    ret   link_packet
.endfunc
