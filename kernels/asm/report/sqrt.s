; Square root of a wide number, correctly rounded, bit by bit: 96 additions, 132 subtractions, 32 multiplications and 32 comparisons
; in a word of 32 bits, for every input (Annex II). Shifts and masks are wiring. In: w0 >= 0. Out: s12. Returns by link_leaf.
; Scratch: s13 to s15, w0 to w5.
.func sqrt
    .computes wsqrt s12, w0, 0
    .holds s12
    wclz  s12, w0
    isubi s12, s12, 65 - 2 * WORD           ; k: how far w0 can go up
    andi  s13, s12, 1
    isub  s12, s12, s13                     ; an even number of bits
    wsll  w0, w0, s12
    wextend w1, s0, 0                       ; r, the root
    movi  s13, 1
    wextend w5, s13, 0
    movi  s14, WORD - 1                     ; i
    .rept WORD
    wsll  w2, w5, s14                       ; b = 2^i
    wadd  w1, w1, w2                        ; r = r + b
    wadd  w3, w1, w1
    wsub  w3, w3, w2                        ; t = 2 r - b
    wmulw w3, w3, w2                        ; p = t b
    wsub  w0, w0, w3                        ; E = E - p
    wltz  w4, w0                            ; m = E < 0: b was too much
    wand  w3, w3, w4
    wadd  w0, w0, w3                        ; E = E + (p & m)
    wand  w2, w2, w4
    wsub  w1, w1, w2                        ; r = r - (b & m)
    isubi s14, s14, 1
    .endr
    ; Up when k = 0 and the remainder E exceeds r, or when the highest bit that goes (number k/2 - 1) is set; never both.
    wsub  w3, w1, w0
    whigh s14, w3
    srai  s14, s14, 31
    clz   s15, s12
    slli  s15, s15, 26
    srai  s15, s15, 31                      ; all ones when k = 0
    and   s14, s14, s15
    srli  s12, s12, 1
    wsll  w3, w1, s13
    wsrl  w3, w3, s12
    wlow  s15, w3
    slli  s15, s15, 31
    srai  s15, s15, 31
    or    s14, s14, s15
    wsrl  w1, w1, s12
    wlow  s12, w1
    isub  s12, s12, s14
    ret   link_leaf
.endfunc
