; A dot product of wide components and a vector: the exact sum, shifted and rounded once.
        vset v1, 2, 3, 5, s1
        vset v2, 7, 11, 13, s1
        vset v3, 1, -2, 4, s1
        wcross w1, v1, v2       ; w1 = -16; w2 = 9; w3 = 1
        wmixed w4, w1, v3, 0    ; w4 = -30
        wmixed w5, w1, v3, 2    ; w5 = -7 -- -7.5
        wmixed w6, w1, v3, 63   ; w6 = 0
        wmixed w7, w1, v1, 0    ; w7 = 0 -- a x b is perpendicular to a
        wmixed w1, w1, v2, 0    ; w1 = 0
        movi s2, 1
        wextend w1, s2, 62
        wextend w2, s2, 62
        wextend w3, s2, 62
        vset v4, 1, 1, 1, s1
        wmixed w4, w1, v4, 0    ; w4 = 0x7fffffffffffffff
        wmixed w4, w1, v4, 1    ; w4 = 0x6000000000000000 -- 3 2^61: the sum of 65 bits is not cut
        vset v5, 0x7fffffff, 0x7fffffff, -0x80000000, s1
        wmixed w5, w1, v5, 31   ; w5 = 0x3fffffff80000000 + 0x3fffffff80000000 - 0x4000000000000000
        halt
