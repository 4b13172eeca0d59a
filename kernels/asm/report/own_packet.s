; The packet in which a ray starts that starts inside the scene's box. In: origin, direction. Out: the packet and its box.
; Returns by link_packet.
.func own_packet
    .holds exit_point, pos
    vmov  exit_point, origin
    call  link_step, descend
    ret   link_packet
.endfunc
