; Unit normal of the nearest triangle, E1 x E2 divided by its length, on the side that the order of its vertices gives. It is computed
; anew wherever it is asked for. Shifts bring edges and product into range first, as a square of the length asks for (5.6): they are
; wiring. In: near_slot. Out: facing. Returns by link_packet. Scratch: s12 to s15, s17, s18, v6 to v8, w0 to w5.
.func normal
    load_triangle near_slot
    .holds v6, pos
    .holds v7, pos
    .holds v8, pos
    subtract v7, v7, v6
    subtract v8, v8, v6
    vnorm v7, s12, v7
    .holds v7
    vnorm v8, s12, v8
    .holds v8
    cross_product v6, v7, v8, WORD - 1
    .holds v6
    vnorm v6, s12, v6
    call  link_step, unit
    .holds v6, dir
    vmov  facing, v6
    ret   link_packet
.endfunc
