; The refracted ray, T = eta (D + c N) - sqrt(k) N, from behind the surface: its parts along the surface and across it, neither longer
; than 1 whatever eta is. Report 4.2, corrected. In: the node's record. Out: origin, direction, the first packet; inside is turned.
; Returns by link_node. Scratch: v6 to v8, s12 to s15, w0.
.func refract
    lw    s13, raynode.k(node)
    .holds s13, dir
    wextend w0, s13, dir
    call  link_leaf, sqrt
    .holds s12, dir
    lv    v6, raynode.normal(node)
    .holds v6, dir
    lv    v7, raynode.incident(node)
    .holds v7, dir
    lw    s13, raynode.cosine(node)
    vscale v8, v6, s13, dir
    .holds v8, dir
    vadd  v7, v7, v8
    lw    s13, raynode.eta(node)
    .holds s13, index
    vscale v7, v7, s13, index
    vscale v6, v6, s12, dir
    vsub  direction, v7, v6
    lv    origin, raynode.behind(node)
    lw    inside, raynode.inside(node)
    movi  s12, 1
    .holds s12
    xor   inside, inside, s12
    call  link_packet, own_packet
    ret   link_node
.endfunc
