; Words of 16 bits have wide accumulators of 32; rows on patterns see the whole register.
; machine: arithmetic.word = 16
        li   s1, 32767
        li   s2, -32768
        wmul w1, s2, s2         ; w1 = 1 << 30
        wmac w1, s2, s2         ; w1 = 0x7fffffff
        wneg w2, w1             ; w2 = -0x7fffffff
        wmsub w2, s2, s2        ; w2 = -0x80000000
        wneg w3, w2             ; w3 = 0x7fffffff
        wround s3, w3, 0        ; s3 = 32767
        wround s4, w3, 16       ; s4 = 32767 -- 32768 - 2^-16
        wround s5, w3, 17       ; s5 = 16384
        wextend w4, s2, 20      ; w4 = -0x80000000
        wsqrt s6, w3, 0         ; s6 = 32767 -- 46341
        movi s7, 8
        wsll w5, w3, s7         ; w5 = 0x7fffffff00
        halt
