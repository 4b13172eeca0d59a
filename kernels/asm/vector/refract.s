; The refracted ray, T = (eta c - sqrt k) N + eta D, from behind the surface. Report 4.2, corrected. In: the node's record.
; Out: origin, direction, the first packet; inside is turned. Returns by link_node. Scratch: v6, v7, s12 to s15, w0 to w2.
.func refract
    lw    s13, raynode.k(node)
    wextend w0, s13, dir
    call  link_leaf, sqrt
    lw    s13, raynode.eta(node)
    lw    s14, raynode.cosine(node)
    wmul  w1, s13, s14
    wextend w2, s12, index
    wsub  w1, w1, w2
    wround s14, w1, index
    lv    v6, raynode.normal(node)
    vscale v6, v6, s14, dir + dir - index
    lv    v7, raynode.incident(node)
    vscale v7, v7, s13, dir
    vadd  direction, v6, v7
.if dir > index
    movi  s12, 1 << (dir - index)
    vscale direction, direction, s12, 0
.endif
    lv    origin, raynode.behind(node)
    lw    inside, raynode.inside(node)
    movi  s12, 1
    xor   inside, inside, s12
    call  link_packet, own_packet
    ret   link_node
.endfunc
