; The packet in which a secondary ray starts, or packet_count = -1 when it starts beside the scene's box and misses it. Origins are moved
; off surfaces, so some lie outside. In: origin, direction. Out: the packet and the walk's notes. Returns by link_packet.
; Scratch: s12 to s15, v6, v7, w0 to w2.
.func own_packet
    lv    v6, ROOT_LOW(s0)
    lv    v7, ROOT_HIGH(s0)
    rbox  came_by, leaves_by, origin, v6
    bwltz leaves_by, 1f
    mov   last_note, s0
    swide leaves_by, NOTES + note.plane(s0)
    li    packet_refs, ROOT
    call  link_step, descend
    ret   link_packet
1:  movi  packet_count, -1
    ret   link_packet
.endfunc
