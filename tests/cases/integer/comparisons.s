; `slt` compares signed numbers; `clz` counts zero bits from the top.
        li   s1, -0x80000000
        movi s2, 1
        slt  s3, s1, s2         ; s3 = 1
        slt  s4, s2, s1         ; s4 = 0
        slt  s5, s2, s2         ; s5 = 0
        clz  s6, s0             ; s6 = 32
        clz  s7, s2             ; s7 = 31
        clz  s8, s1             ; s8 = 0
        movi s9, -1
        clz  s9, s9             ; s9 = 0
        li   s10, 0x00ff0000
        clz  s10, s10           ; s10 = 8
        halt                    ; count: cmp 3, move 6, logic 5, jump 1
