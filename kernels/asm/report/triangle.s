; Ray against the triangle in the slot, as the report writes it (3.1.2): scalar operations, each rounded to a word; no early out,
; inclusive comparisons, (1 / det) x written three times. 9 additions, 15 subtractions, 27 multiplications, 3 divisions and
; 7 comparisons for every input (Annex II).
;
; A product of two positions is kept WORD bits lower. Edges and determinant are shifted into range first, and the quotients back: a
; cadrage (5.6), which the annex counts as little as the square root's. Without it the determinant of a small triangle would be 0.
;
; In: slot, origin, direction. Out: s12 = t, or MISSED. Returns by link_step. Scratch: s12, s17, s18, v6 to v17.

.equ INVERSE, 2 * WORD - 5              ; fraction bits of 1 / det beyond those of a determinant

; s12 = (1 / det) s12. Scratch: s17, s18.
.macro over_determinant shift
    movi  s17, 1
    vget  s18, v12, x
    div   s17, s17, s18, INVERSE
    mul   s12, s17, s12, \shift
.endm

; s12, shifted as what stands in component \component of v14. Scratch: s17.
.macro shift_with component
    vget  s17, v14, \component
    scale s12, s12, s17
.endm

; \d = \a, shifted into range; by how much goes to component \component of v14. Scratch: s17.
.macro shift_into_range d, a, component
    vnorm \d, s17, \a
    vput  v14, s17, \component
.endm

.func triangle
    load_triangle slot
    .holds v6, pos
    .holds v7, pos
    .holds v8, pos
    subtract v7, v7, v6                 ; E1
    subtract v8, v8, v6                 ; E2
    subtract v9, origin, v6             ; T
    .holds v9, pos
    shift_into_range v7, v7, x
    .holds v7
    shift_into_range v8, v8, y
    .holds v8
    cross_product v10, direction, v8, dir   ; P = D x E2
    cross_product v11, v9, v7, WORD     ; Q = T x E1
    dot_product v10, v7, WORD
    vmov  v12, zero_vector
    vput  v12, s12, x
    shift_into_range v12, v12, z        ; det = P . E1
    dot_product v10, v9, WORD
    shift_with z
    shift_with x
    over_determinant INVERSE - bary
    .holds s12, bary
    vput  v13, s12, x                   ; u = (1 / det) P . T
    .holds s12
    dot_product v11, direction, dir
    shift_with z
    shift_with y
    over_determinant INVERSE - bary
    .holds s12, bary
    vput  v13, s12, y                   ; v = (1 / det) Q . D
    .holds s12
    dot_product v11, v8, WORD
    shift_with z
    over_determinant INVERSE - WORD - t + pos
    .holds s12, t
    vput  v13, s12, z                   ; t = (1 / det) Q . E2

    ; s12 becomes 1 when any of the seven conditions fails.
    vget  s17, v12, x
    .holds s12
    .holds s17
    clz   s17, s17
    movi  s18, 31
    slt   s12, s18, s17                 ; det = 0: 32 leading zeros
    vget  s17, v13, x
    .holds s17, bary
    slt   s18, s17, s0
    or    s12, s12, s18                 ; u < 0
    li    s18, 1:bary
    slt   s18, s18, s17
    or    s12, s12, s18                 ; u > 1
    vget  s17, v13, y
    slt   s18, s17, s0
    or    s12, s12, s18                 ; v < 0
    li    s18, 1:bary
    slt   s18, s18, s17
    or    s12, s12, s18                 ; v > 1
    vget  s18, v13, x
    add   s17, s17, s18
    li    s18, 1:bary
    slt   s18, s18, s17
    or    s12, s12, s18                 ; u + v > 1
    vget  s17, v13, z
    .holds s17, t
    movi  s18, 1
    slt   s18, s17, s18
    or    s12, s12, s18                 ; t <= 0

    slli  s12, s12, 31
    srai  s12, s12, 31
    li    s18, MISSED
    or    s17, s17, s12
    and   s12, s17, s18                 ; t, or MISSED: all ones but the sign
    .holds s12, t
    ret   link_step
.endfunc
