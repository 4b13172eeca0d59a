; A product is rounded once, to the nearest, ties up, and then saturates.
        .format pos, 16
        .format dir, 30
        li   s1, 3
        li   s2, -3
        li   s3, 1
        mul  s4, s1, s3, 0      ; s4 = 3
        mul  s5, s1, s3, 1      ; s5 = 2 -- 1.5
        mul  s6, s2, s3, 1      ; s6 = -1 -- -1.5
        mul  s7, s1, s3, 2      ; s7 = 1 -- 0.75
        mul  s8, s2, s3, 2      ; s8 = -1 -- -0.75
        mul  s9, s3, s3, 1      ; s9 = 1 -- 0.5
        mul  s10, s2, s3, 3     ; s10 = 0 -- -0.375
        li   s11, 1.5:pos
        li   s12, -0.25:dir
        mul  s13, s11, s12, 30  ; s13 = -0.375:pos
        li   s14, 0x7fffffff
        li   s15, -0x80000000
        mul  s16, s14, s14, 0   ; s16 = 0x7fffffff
        mul  s17, s14, s15, 0   ; s17 = -0x80000000
        mul  s18, s15, s15, 31  ; s18 = 0x7fffffff -- 2^31
        mul  s19, s15, s15, 32  ; s19 = 0x40000000
        mul  s20, s14, s15, 31  ; s20 = -0x7fffffff
        mul  s21, s14, s14, 31  ; s21 = 0x7ffffffe -- 2^31 - 2 + 2^-31
        mul  s22, s15, s15, 62  ; s22 = 1
        mul  s23, s15, s15, 63  ; s23 = 1 -- 0.5 goes up
        mul  s24, s14, s15, 63  ; s24 = 0 -- a little above -0.5
        halt                    ; count: mul 17, move 11, jump 1
