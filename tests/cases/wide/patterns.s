; Rows on the 64 bits of the register.
        li   s1, 0x0000ffff
        li   s2, 0x80000001
        wjoin w1, s1, s2        ; w1 = 0x0000ffff80000001
        wjoin w2, s2, s1        ; w2 = -0x7ffffffeffff0001
        whigh s3, w1            ; s3 = 0xffff
        wlow s4, w1             ; s4 = 0x80000001
        whigh s5, w2            ; s5 = 0x80000001
        wlow s6, w2             ; s6 = 0xffff
        wand w3, w1, w2         ; w3 = 0x100000001
        wclz s7, w1             ; s7 = 16
        wclz s8, w2             ; s8 = 0
        wclz s9, w0             ; s9 = 64
        wltz w4, w1             ; w4 = 0
        wltz w5, w2             ; w5 = -1
        movi s10, 4
        movi s11, -1
        movi s12, 64
        wsll w6, w1, s10        ; w6 = 0x000ffff800000010
        wsrl w6, w2, s10        ; w6 = 0x0800000010000fff -- zeros come in
        wsll w6, w1, s11        ; w6 = -0x7fffffffffffffff - 1 -- by 63
        wsrl w6, w2, s11        ; w6 = 1
        wsll w6, w1, s12        ; w6 = 0x0000ffff80000001 -- by 0
        wsrl w6, w2, s12        ; w6 = -0x7ffffffeffff0001
        halt                    ; count: cmp 2, move 13, logic 10, jump 1
