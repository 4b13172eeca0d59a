; The direction of an exact cross product, scaled by a power of two to 29 or 30 bits.
        vset v1, 1, 0, 0, s1
        vset v2, 0, 1, 0, s1
        vcrossn v3, v1, v2      ; v3 = 0, 0, 1 << 29
        vcrossn v4, v2, v1      ; v4 = 0, 0, -(1 << 29)
        vset v5, 2, 3, 5, s1
        vset v6, 7, 11, 13, s1
        vcrossn v7, v5, v6      ; v7 = -16 << 25, 9 << 25, 1 << 25
        vcrossn v8, v5, v5      ; v8 = 0, 0, 0
        vset v9, -0x80000000, 0x7fffffff, 0, s1
        vset v10, -0x80000000, -0x80000000, 0, s1
        vcrossn v11, v9, v10    ; v11 = 0, 0, 1 << 30 -- 2^63 - 2^31 over 2^33 rounds up
        vset v12, 0x40000000, 3, 0, s1
        vset v13, 0, 0, 1, s1
        vcrossn v14, v12, v13   ; v14 = 2, -(1 << 29), 0 -- 3, -2^30 over 2
        halt                    ; count: sub 18, mul 36, move 53, logic 18, jump 1
