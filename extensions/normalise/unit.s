; Unit vector in the direction of v6, from a vector scaled into [2^(word-3), 2^(word-2)]: its square fits a wide number, and its
; length a word. In: v6. Out: v6 in the direction format, within 1.5 ulp a component: half for the quotient, up to one for the length, which is
; as short as 2^(word-3). Returns by link_step. Scratch: s12, w0.
.func unit
;-    wdot  w0, v6, v6
;-    call  link_leaf, sqrt
;-    .holds s12
;-    vdiv  v6, v6, s12, dir
;-    .holds v6, dir
    vunit v6, v6, dir ;+
    ret   link_step
.endfunc
