        vset v1, -5, 0x7fffffff, 3, s1
        vset v2, 4, -0x80000000, 3, s1
        vmin v3, v1, v2         ; v3 = -5, -0x80000000, 3
        vmax v4, v1, v2         ; v4 = 4, 0x7fffffff, 3
        vmin v1, v2, v1         ; v1 = -5, -0x80000000, 3
        halt
