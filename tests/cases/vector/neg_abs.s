; The least number saturates in each component.
        vset v1, -0x80000000, 0, 9, s1
        vset v2, -1, 0x7fffffff, -0x7fffffff, s1
        vneg v3, v1             ; v3 = 0x7fffffff, 0, -9
        vneg v4, v2             ; v4 = 1, -0x7fffffff, 0x7fffffff
        vabs v5, v1             ; v5 = 0x7fffffff, 0, 9
        vabs v6, v2             ; v6 = 1, 0x7fffffff, 0x7fffffff
        halt
