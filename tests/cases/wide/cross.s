; Three exact components.
        vset v1, 2, 3, 5, s1
        vset v2, 7, 11, 13, s1
        wcross w1, v1, v2       ; w1 = -16; w2 = 9; w3 = 1; w4 = 0
        vset v3, -0x80000000, 0x7fffffff, 0, s1
        vset v4, -0x80000000, -0x80000000, 0, s1
        wcross w5, v3, v4       ; w5 = 0; w6 = 0; w7 = 0x7fffffff80000000
        wcross w0, v4, v3       ; w2 = -0x7fffffff80000000; w1 = 0; w0 = 0
        halt                    ; count: sub 9, mul 18, move 28, jump 1
