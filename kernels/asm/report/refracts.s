; Whether the refracted ray meets a surface: the search for its nearest hit. In: node, which has waited while the walk was in its
; reflected sister. Out: the ray, near (0: none), near_t, near_slot. Returns by link_node.
.func refracts
    .holds origin, pos
    .holds direction, dir
    lv    origin, treenode.origin(node)
    lv    direction, treenode.direction(node)
    seek_nearest
    call  link_packet, own_packet
    call  link_trace, trace
    ret   link_node
.endfunc
