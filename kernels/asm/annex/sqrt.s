; Driver for the square root: small, large, square and non-square operands, one call each.
.entry driver
.func driver
    .holds s12
    movi  s20, OPERANDS
1:  lwide w0, (s20)
    call  link_leaf, sqrt
    lea   s20, 8(s20)
    movi  s21, OPERANDS_END
    bltu  s20, s21, 1b
    halt
.endfunc
.buffer
OPERANDS: .wide 0, 1, 2, 3, 4, 1000000, 1 << 31, (1 << 31) - 1, 1 << 60, (1 << 62) - 1, 4611686014132420608
OPERANDS_END:
.text
