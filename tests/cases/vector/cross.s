; Each component is one rounding of the exact difference of two products.
        vset v1, 1, 0, 0, s1
        vset v2, 0, 1, 0, s1
        vcross v3, v1, v2, 0    ; v3 = 0, 0, 1
        vcross v4, v2, v1, 0    ; v4 = 0, 0, -1
        vset v5, 2, 3, 5, s1
        vset v6, 7, 11, 13, s1
        vcross v7, v5, v6, 0    ; v7 = -16, 9, 1
        vcross v8, v5, v6, 1    ; v8 = -8, 5, 1
        vcross v9, v5, v5, 0    ; v9 = 0, 0, 0
        vset v10, -0x80000000, 0x7fffffff, 0, s1
        vset v11, 0x7fffffff, -0x80000000, 0, s1
        vcross v12, v10, v11, 0 ; v12 = 0, 0, 0x7fffffff
        vcross v12, v10, v11, 32 ; v12 = 0, 0, 1 -- 2^62 - (2^31 - 1)^2 = 2^32 - 1
        vset v13, -0x80000000, -0x80000000, 0, s1
        vcross v14, v10, v13, 32 ; v14 = 0, 0, 0x7fffffff -- 2^63 - 2^31 over 2^32 is 2^31 - 0.5
        vcross v14, v10, v13, 33 ; v14 = 0, 0, 0x40000000
        halt
