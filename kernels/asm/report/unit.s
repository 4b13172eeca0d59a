; Unit vector in the direction of v6, from a vector scaled into [2^(word-3), 2^(word-2)]: a square root, one division and three products
; with its quotient. In: v6. Out: v6 in the direction format. Returns by link_step. Scratch: s12 to s15, s17, w0 to w5.

.equ INVERSE_LENGTH, 2 * WORD - 5       ; fraction bits of 1 / length beyond those of a length

.func unit
    vget  s12, v6, x
    .holds s12
    wmul  w0, s12, s12
  .rept 2, k
    vget  s12, v6, k + 1
    wmac  w0, s12, s12
  .endr
    call  link_leaf, sqrt
    movi  s13, 1
    div   s12, s13, s12, INVERSE_LENGTH
    scale_vector v6, v6, s12, INVERSE_LENGTH - dir
    .holds v6, dir
    ret   link_step
.endfunc
