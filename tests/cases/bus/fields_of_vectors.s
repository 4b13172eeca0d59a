; Nine numbers of four bits in five octets.
        li    s1, 0xfedcba98
        stw   s1, 8(s0)
        movi  s1, 7
        stw   s1, 12(s0)
        movi  s2, 10
        ldv3f v1, -2(s2), 4             ; v1 = -8, -7, -6; v2 = -5, -4, -3; v3 = -2, -1, 7
        halt
