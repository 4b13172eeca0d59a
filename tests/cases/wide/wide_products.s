; The product of two wide numbers saturates like any other wide result.
        movi s1, 1
        movi s2, -3
        wextend w1, s1, 32
        wextend w2, s2, 0
        wmulw w3, w1, w2        ; w3 = -3 << 32
        wmulw w4, w1, w1        ; w4 = 0x7fffffffffffffff -- 2^64
        wmulw w5, w3, w1        ; w5 = -0x7fffffffffffffff - 1
        wmulw w6, w3, w3        ; w6 = 0x7fffffffffffffff
        wmulw w7, w2, w2        ; w7 = 9
        halt
