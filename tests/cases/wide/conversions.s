; From scalar to wide by a shift to the left, back by a rounded shift to the right.
        movi s1, 5
        movi s2, -5
        wextend w1, s1, 0       ; w1 = 5
        wextend w2, s2, 40      ; w2 = -5 << 40
        wextend w3, s1, 61      ; w3 = 0x7fffffffffffffff
        wextend w4, s2, 61      ; w4 = -0x7fffffffffffffff - 1
        wextend w5, s0, 63      ; w5 = 0
        wround s3, w1, 0        ; s3 = 5
        wround s4, w1, 1        ; s4 = 3
        wround s5, w2, 41       ; s5 = -2 -- -2.5
        wround s6, w2, 0        ; s6 = -0x80000000
        wround s7, w2, 10       ; s7 = -0x80000000 -- -5 2^30
        wround s8, w2, 12       ; s8 = -5 << 28
        wround s9, w3, 32       ; s9 = 0x7fffffff -- 2^31 - 2^-32
        wround s10, w3, 63      ; s10 = 1
        wround s11, w4, 63      ; s11 = -1
        movi s12, 41
        movi s13, -28
        movi s14, -500
        movi s15, 500
        wscale s16, w2, s12     ; s16 = -2
        wscale s17, w1, s13     ; s17 = 5 << 28
        wscale s18, w1, s14     ; s18 = 0x7fffffff
        wscale s19, w2, s14     ; s19 = -0x80000000
        wscale s20, w4, s15     ; s20 = -1 -- by 63
        wscale s21, w5, s14     ; s21 = 0
        wscale s22, w2, s0      ; s22 = -0x80000000
        halt                    ; count: move 6, logic 21, jump 1
