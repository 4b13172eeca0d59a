; Products of scalars are exact; sums of them saturate at 64 bits.
        li   s1, 0x7fffffff
        li   s2, -0x80000000
        movi s3, -3
        wmul w1, s1, s1         ; w1 = 0x3fffffff00000001
        wmul w2, s2, s2         ; w2 = 1 << 62
        wmul w3, s1, s2         ; w3 = -0x3fffffff80000000
        wmul w4, s3, s0         ; w4 = 0
        wmac w2, s2, s2         ; w2 = 0x7fffffffffffffff -- 2^63
        wmac w4, s3, s3         ; w4 = 9
        wmsub w4, s1, s3        ; w4 = 9 + 3 * 0x7fffffff
        wmsub w3, s2, s2        ; w3 = -0x7fffffff80000000
        wmsub w3, s2, s2        ; w3 = -0x7fffffffffffffff - 1
        wmac w1, s1, s2         ; w1 = -0x7fffffff -- 2^31 - 1 times -1
        halt                    ; count: add 3, sub 3, mul 10, move 5, jump 1
