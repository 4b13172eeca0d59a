; The exact sum of three products saturates once.
        vset v1, 1, 2, 3, s1
        vset v2, 4, -5, 6, s1
        wdot w1, v1, v2         ; w1 = 12
        vset v3, -0x80000000, -0x80000000, -0x80000000, s1
        wdot w2, v3, v3         ; w2 = 0x7fffffffffffffff -- 3 2^62
        vset v4, -0x80000000, -0x80000000, 1, s1
        wdot w3, v3, v4         ; w3 = 0x7fffffff80000000 -- 2^63 - 2^31
        halt
