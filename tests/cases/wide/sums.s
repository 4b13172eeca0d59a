        li   s1, 0x7fffffff
        movi s2, -1
        movi s3, 1
        wjoin w1, s1, s2        ; w1 = 0x7fffffffffffffff
        wextend w2, s3, 0       ; w2 = 1
        wextend w3, s2, 63      ; w3 = -0x7fffffffffffffff - 1
        wadd w4, w1, w2         ; w4 = 0x7fffffffffffffff
        wadd w5, w1, w3         ; w5 = -1
        wsub w6, w3, w2         ; w6 = -0x7fffffffffffffff - 1
        wsub w6, w5, w1         ; w6 = -0x7fffffffffffffff - 1
        wsub w6, w2, w1         ; w6 = -0x7ffffffffffffffe
        wneg w7, w3             ; w7 = 0x7fffffffffffffff
        wneg w7, w2             ; w7 = -1
        wmov w0, w6             ; w0 = -0x7ffffffffffffffe -- no wide accumulator reads zero
        halt                    ; count: add 2, sub 5, move 6, logic 2, jump 1
