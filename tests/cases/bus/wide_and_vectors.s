; More than a word in one transfer.
        li    s1, 0x04030201
        movi  s2, 10
        stw   s1, -3(s2)
        ldwide w1, -4(s2)
        vset  v1, 1, -1, 256, s5
        stv   v1, 20(s0)
        ldv3  v2, 8(s2)
        halt                            ; count: mem 4, octet 60, move 9, jump 1
