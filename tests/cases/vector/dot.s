; One rounding of the exact sum, even where it needs 65 bits.
        vset v1, 1, 2, 3, s1
        vset v2, 4, -5, 6, s1
        vdot s2, v1, v2, 0      ; s2 = 12
        vdot s3, v1, v2, 3      ; s3 = 2 -- 1.5
        vset v3, 1, 1, 1, s1
        vdot s4, v3, v3, 1      ; s4 = 2 -- 1.5, not three halves rounded one by one
        vset v4, -0x80000000, -0x80000000, -0x80000000, s1
        vdot s5, v4, v4, 0      ; s5 = 0x7fffffff -- 3 2^62
        vdot s6, v4, v4, 33     ; s6 = 3 << 29
        vdot s7, v4, v4, 63     ; s7 = 2 -- 1.5
        vset v5, -0x80000000, -0x80000000, 0x7fffffff, s1
        vdot s8, v4, v5, 63     ; s8 = 1 -- 2^63 - 2^62 + 2^31
        vset v6, 0x7fffffff, 0x7fffffff, 0x7fffffff, s1
        vdot s9, v4, v6, 33     ; s9 = -1610612735 -- -3 2^29 + 0.75
        halt
