; The largest component gets 29 or 30 bits; the second result is the shift to the right.
        vset v1, 1, 0, -3, s1
        vnorm v2, s2, v1        ; v2 = 1 << 28, 0, -3 << 28; s2 = -28
        vset v3, -0x80000000, 3, 5, s1
        vnorm v4, s3, v3        ; v4 = -(1 << 29), 1, 1; s3 = 2 -- 0.75, 1.25
        vset v5, 0x7fffffff, 2, 6, s1
        vnorm v6, s4, v5        ; v6 = 1 << 30, 1, 3; s4 = 1 -- the first rounds up
        vnorm v7, s5, v0        ; v7 = 0, 0, 0; s5 = 0
        vset v8, 0x3fffffff, 1, 0, s1
        vnorm v9, s6, v8        ; v9 = 0x3fffffff, 1, 0; s6 = 0
        vset v10, -0x40000000, 1, 0, s1
        vnorm v11, s7, v10      ; v11 = -0x20000000, 1, 0; s7 = 1 -- 0.5 goes up
        halt
