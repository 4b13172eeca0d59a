; Ray against the triangle in the slot: Moeller-Trumbore on exact products. Signs are tested before anything is divided, and the
; one quotient is rounded once. Decisions are exact as long as EDGE_SHIFT is 0; beyond, each determinant is rounded to 2 x word bits.
; Both triangles of an edge round the same determinant of it, so a ray that hits the edge still hits one of them.
;
; In: slot, origin, direction. Out: s12 = t, or MISSED. Returns by link_step. Scratch: v6 to v11, s12, w0 to w7.

; Decides a number that is exactly 0 as if the direction were moved by (e, e^2, e^3), e infinitely small: by the first component other
; than 0 of the wide normal \n. Falls through when that has the sign asked for; a normal of 0 is a miss.
.macro decide_tie sign, n, n1, n2
    bwnez \n, decided_\@
    wmov  \n, \n1
    bwnez \n, decided_\@
    wmov  \n, \n2
    bweqz \n, triangle_missed
decided_\@:
  .if \sign > 0
    bwltz \n, triangle_missed
  .else
    bwgez \n, triangle_missed
  .endif
.endm

; Falls through when the number \x (wide) has the sign asked for, branches to \tie when it is 0.
.macro want sign, x, tie
  .if \sign > 0
    bwltz \x, triangle_missed
    bweqz \x, \tie
  .else
    bwltz \x, wanted_\@
    bweqz \x, \tie
    jump  triangle_missed
wanted_\@:
  .endif
.endm

; The tests of u, v, u + v and t for a determinant (w3) of the given sign.
.macro side sign
    wmixed w4, w0, v9, EDGE_SHIFT           ; u det
    want  \sign, w4, tie_u_\@
u_\@:
    wcross w0, v9, v7                       ; Q = T x E1
    wsub  w4, w3, w4
    wmixed w5, w0, direction, EDGE_SHIFT    ; v det
    want  \sign, w5, tie_v_\@
v_\@:
    wsub  w4, w4, w5                        ; (1 - u - v) det
.if EDGE_SHIFT > 0
    ; Each of the three numbers is rounded, in whatever mode, by less than 1, so their difference is off by less than 3: from -4 to 3 the
    ; edge's own determinant decides. -5 + 4 is negative, -4 + 4 to 3 + 4 are 0 behind 3 bits, 4 + 4 is not.
    movi  s12, 4
    wextend w5, s12, 0
    wadd  w4, w4, w5
    movi  s12, 3
  .if \sign > 0
    bwltz w4, triangle_missed
    wsrl  w4, w4, s12
    bweqz w4, third_\@
  .else
    bwltz w4, w_\@
    wsrl  w4, w4, s12
    bweqz w4, third_\@
    jump  triangle_missed
  .endif
.else
    want  \sign, w4, third_\@
.endif
w_\@:
    wmixed w4, w0, v8, T_SHIFT              ; t det
    want  \sign, w4, triangle_missed
    wdiv  s12, w4, w3, T_QUOTIENT
    ret   link_step
tie_u_\@:
    wcross w5, v8, v9
    decide_tie \sign, w5, w6, w7
    jump  u_\@
tie_v_\@:
    wmov  w5, w0                            ; Q itself is needed for t
    wmov  w6, w1
    wmov  w7, w2
    decide_tie \sign, w5, w6, w7
    wextend w5, s0, 0
    jump  v_\@
third_\@:
    vsub  v10, v8, v9
    vsub  v11, v7, v9
    wcross w5, v10, v11
.if EDGE_SHIFT > 0
    wmixed w4, w5, direction, EDGE_SHIFT
    want  \sign, w4, tie_w_\@
    jump  w_\@
tie_w_\@:
.endif
    decide_tie \sign, w5, w6, w7
    jump  w_\@
.endm

.func triangle
    load_triangle slot
    .holds v6, pos
    .holds v7, pos
    .holds v8, pos
    vsub  v7, v7, v6                        ; E1
    vsub  v8, v8, v6                        ; E2
    vsub  v9, origin, v6                    ; T
    .holds v9, pos
    wcross w0, direction, v8                ; P = D x E2
    wmixed w3, w0, v7, EDGE_SHIFT           ; det
    bwltz w3, triangle_from_behind
    bweqz w3, triangle_missed
    .holds s12, t
    side  1
triangle_from_behind:
    side  -1
triangle_missed:
    li    s12, MISSED
    ret   link_step
.endfunc
