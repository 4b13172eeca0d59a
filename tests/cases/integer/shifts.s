; The low five bits of a register say how far.
        li   s1, 0x80000001
        movi s2, 33
        movi s3, -1
        sll  s4, s1, s2         ; s4 = 2
        srl  s5, s1, s2         ; s5 = 0x40000000
        sra  s6, s1, s2         ; s6 = 0xc0000000
        sll  s7, s1, s3         ; s7 = 0x80000000 -- by 31
        srl  s8, s1, s3         ; s8 = 1
        sra  s9, s1, s3         ; s9 = -1
        slli s10, s1, 0         ; s10 = 0x80000001
        slli s11, s1, 31        ; s11 = 0x80000000
        srli s12, s1, 31        ; s12 = 1
        srai s13, s1, 4         ; s13 = 0xf8000000
        srai s14, s3, 31        ; s14 = -1
        halt                    ; count: move 4, logic 11, jump 1
