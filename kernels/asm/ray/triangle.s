; Ray against the triangle in the slot, exactly: t is the one number that is rounded.
; In: slot, origin, direction. Out: s12 = t > 0, or MISSED. Returns by link_step. Scratch: v6 to v9.
.func triangle
    load_triangle slot
    .holds v6, pos
    .holds v7, pos
    .holds v8, pos
    rtri  s12, v9, origin, v6, dir + t - pos
    .holds s12, t
    ret   link_step
.endfunc
