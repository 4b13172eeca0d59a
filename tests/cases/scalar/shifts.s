; To the right with rounding, to the left with saturation; `scale` does both.
        movi s1, 5
        movi s2, -5
        rshift s3, s1, 0        ; s3 = 5
        rshift s4, s1, 1        ; s4 = 3 -- 2.5
        rshift s5, s2, 1        ; s5 = -2 -- -2.5
        rshift s6, s1, 2        ; s6 = 1 -- 1.25
        rshift s7, s2, 3        ; s7 = -1 -- -0.625
        rshift s8, s2, 63       ; s8 = 0
        lshift s9, s2, 0        ; s9 = -5
        lshift s10, s2, 28      ; s10 = -5 << 28
        lshift s11, s2, 29      ; s11 = -0x80000000 -- -5 2^29 is below the least one
        lshift s12, s1, 29      ; s12 = 0x7fffffff
        lshift s13, s1, 63      ; s13 = 0x7fffffff
        lshift s14, s0, 63      ; s14 = 0
        movi s15, 1
        movi s16, -28
        movi s17, 200
        movi s18, -200
        scale s19, s1, s0       ; s19 = 5
        scale s20, s1, s15      ; s20 = 3
        scale s21, s2, s16      ; s21 = -5 << 28
        scale s22, s2, s17      ; s22 = 0
        scale s23, s2, s18      ; s23 = -0x80000000
        scale s24, s0, s18      ; s24 = 0
        halt                    ; count: move 6, logic 18, jump 1
