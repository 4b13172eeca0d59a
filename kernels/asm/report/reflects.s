; Whether the reflected ray meets a surface: the search for its nearest hit. In: the ray. Out: near (0: none), near_t, near_slot.
; Returns by link_node.
.func reflects
    .holds origin, pos
    .holds direction, dir
    seek_nearest
    call  link_packet, own_packet
    call  link_trace, trace
    ret   link_node
.endfunc
