; Three signed numbers of 16 bits, moved up; what leaves the 32 bits is cut off.
        lvh  v1, 0(s0), 0       ; v1 = 1, -1, 0x7fff
        lvh  v2, 0(s0), 16      ; v2 = 0x10000, -0x10000, 0x7fff0000
        lvh  v3, 0(s0), 31      ; v3 = -0x80000000, -0x80000000, -0x80000000
        lvh  v4, 0(s0), 17      ; v4 = 0x20000, -0x20000, 0xfffe0000
        lvh  v5, 0(s0), 63      ; v5 = 0, 0, 0
        movi s1, 514
        lvh  v6, -512(s1), 1    ; v6 = -2, 0xfffe, 4
        movi s1, -507
        lvh  v7, 511(s1), 0     ; v7 = 0x7fff, 2, 3
        halt                    ; count: move 2, jump 1, local 21
        .buffer
        .half 1, -1, 0x7fff, 2, 3
