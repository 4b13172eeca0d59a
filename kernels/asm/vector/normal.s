; Unit normal of the nearest triangle, facing the ray, and the cosine of incidence.
; In: near_slot, direction. Out: facing, cosine >= 0. Returns by link_packet. Report 4.1: N is on the side the ray comes from.
.func normal
    load_triangle near_slot
    .holds v6, pos
    .holds v7, pos
    .holds v8, pos
    vsub  v9, v7, v6
    .holds v9, pos
    vsub  v10, v8, v6
    .holds v10, pos
    vcrossn v6, v9, v10
    .holds v6
    call  link_step, unit
    .holds v6, dir
    vdot  cosine, v6, direction, dir
    blez  cosine, 1f
    vneg  facing, v6
    ret   link_packet
1:  vmov  facing, v6
    neg   cosine, cosine
    ret   link_packet
.endfunc
