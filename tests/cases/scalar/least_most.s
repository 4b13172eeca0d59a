; Comparisons are signed.
        li   s1, -0x80000000
        li   s2, 0x7fffffff
        min  s3, s1, s2         ; s3 = -0x80000000
        max  s4, s1, s2         ; s4 = 0x7fffffff
        min  s5, s2, s1         ; s5 = -0x80000000
        max  s6, s0, s1         ; s6 = 0
        min  s7, s2, s2         ; s7 = 0x7fffffff
        max  s8, s1, s1         ; s8 = -0x80000000
        halt                    ; count: cmp 6, move 4, jump 1
