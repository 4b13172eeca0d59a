; Ray against the triangle in the slot, as the report writes it (3.1.2): scalar operations, each rounded to a word; no early out,
; inclusive comparisons, (1 / det) x written three times. 9 additions, 15 subtractions, 27 multiplications, 3 divisions and
; 7 comparisons for every input (Annex II).
;
; A product of two positions is kept WORD bits lower. The determinant of a small triangle underflows, and the inverse of one below
; 2^(INVERSE - WORD + 1) saturates: that is what one format a quantity does to this arrangement.
;
; In: slot, origin, direction. Out: s12 = t, or MISSED. Returns by link_step. Scratch: s12, s17, s18, v6 to v17.

.equ INVERSE, 3 * WORD / 2 - 2          ; fraction bits of 1 / det beyond those of a determinant

; \d = \a - \b
.macro subtract d, a, b
  .rept 3, k
    vget  s17, \a, k
    vget  s18, \b, k
    sub   s17, s17, s18
    vput  \d, s17, k
  .endr
.endm

; s12 = \a . \b
.macro dot_product a, b, shift
    vget  s12, \a, x
    vget  s17, \b, x
    mul   s12, s12, s17, \shift
  .rept 2, k
    vget  s17, \a, k + 1
    vget  s18, \b, k + 1
    mul   s17, s17, s18, \shift
    add   s12, s12, s17
  .endr
.endm

; \d = \a x \b
.macro cross_product d, a, b, shift
  .rept 3, k
    vget  s12, \a, (k + 1) % 3
    vget  s17, \b, (k + 2) % 3
    mul   s12, s12, s17, \shift
    vget  s17, \a, (k + 2) % 3
    vget  s18, \b, (k + 1) % 3
    mul   s17, s17, s18, \shift
    sub   s12, s12, s17
    vput  \d, s12, k
  .endr
.endm

; s12 = (1 / det) s12. Scratch: s17, s18.
.macro over_determinant shift
    movi  s17, 1
    vget  s18, v12, x
    div   s17, s17, s18, INVERSE
    mul   s12, s17, s12, \shift
.endm

.func triangle
    load_triangle slot
    subtract v7, v7, v6                 ; E1
    subtract v8, v8, v6                 ; E2
    subtract v9, origin, v6             ; T
    cross_product v10, direction, v8, dir   ; P = D x E2
    cross_product v11, v9, v7, WORD     ; Q = T x E1
    dot_product v10, v7, WORD
    vput  v12, s12, x                   ; det = P . E1
    dot_product v10, v9, WORD
    over_determinant INVERSE - bary
    vput  v13, s12, x                   ; u = (1 / det) P . T
    dot_product v11, direction, dir
    over_determinant INVERSE - bary
    vput  v13, s12, y                   ; v = (1 / det) Q . D
    dot_product v11, v8, WORD
    over_determinant INVERSE - WORD - t + pos
    vput  v13, s12, z                   ; t = (1 / det) Q . E2

    ; s12 becomes 1 when any of the seven conditions fails.
    vget  s17, v12, x
    clz   s17, s17
    movi  s18, 31
    slt   s12, s18, s17                 ; det = 0: 32 leading zeros
    vget  s17, v13, x
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
    movi  s18, 1
    slt   s18, s17, s18
    or    s12, s12, s18                 ; t <= 0

    slli  s12, s12, 31
    srai  s12, s12, 31
    li    s18, MISSED
    or    s17, s17, s12
    and   s12, s17, s18                 ; t, or MISSED: all ones but the sign
    ret   link_step
.endfunc
