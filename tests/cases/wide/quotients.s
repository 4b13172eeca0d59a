; One rounding of the exact quotient.
        movi s1, 7
        movi s2, -2
        wextend w1, s1, 0
        wextend w2, s2, 0
        wdiv s3, w1, w2, 0      ; s3 = -3 -- -3.5
        wdiv s4, w2, w1, 30     ; s4 = -306783378
        wdiv s5, w1, w2, 63     ; s5 = -0x80000000
        wextend w3, s2, 62      ; w3 = -0x7fffffffffffffff - 1
        wdiv s6, w3, w3, 0      ; s6 = 1
        wdiv s7, w3, w3, 30     ; s7 = 1 << 30
        wdiv s8, w3, w3, 63     ; s8 = 0x7fffffff
        wdiv s9, w2, w3, 63     ; s9 = 2
        wdiv s10, w2, w3, 60    ; s10 = 0 -- 2^-2
        wdiv s11, w2, w3, 61    ; s11 = 1 -- 0.5
        wdiv s12, w1, w4, 0     ; s12 = 0x7fffffff -- by zero
        wdiv s13, w3, w4, 0     ; s13 = -0x80000000
        wdiv s14, w4, w4, 0     ; s14 = 0
        halt                    ; count: div 12, move 2, logic 3, jump 1
