; The packet in which a secondary ray starts, or packet_count = -1 when it starts beside the scene's box and misses it. Origins are moved
; off surfaces, so some lie outside. In: origin, direction. Out: the packet and the walk's notes. Returns by link_packet.
; Scratch: s12 to s15, v6, v7, w0 to w2.
.func own_packet
    walk_names
    .holds v6, pos
    .holds v7, pos
    enter_scene 1f
    ret   link_packet
1:  movi  packet_count, -1
    ret   link_packet
.endfunc
