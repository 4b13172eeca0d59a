        vset v1, 7, -7, 0, s1
        movi s2, 2
        vdiv v2, v1, s2, 0      ; v2 = 4, -3, 0 -- 3.5, -3.5
        vdiv v3, v1, s2, 2      ; v3 = 14, -14, 0
        vdiv v4, v1, s2, 31     ; v4 = 0x7fffffff, -0x80000000, 0
        vdiv v5, v1, s0, 0      ; v5 = 0x7fffffff, -0x80000000, 0
        halt                    ; count: div 12, move 7, jump 1
