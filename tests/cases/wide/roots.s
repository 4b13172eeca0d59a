; A root is correctly rounded to the nearest. It is never a tie.
        .format dir, 30
        movi s1, 2
        wextend w1, s1, 0
        wsqrt s2, w1, 0         ; s2 = 1 -- 1.41
        wsqrt s3, w1, 1         ; s3 = 2
        wsqrt s4, w1, 60        ; s4 = 1518500250 -- 1518500249.99
        wsqrt s5, w1, 63        ; s5 = 0x7fffffff -- 2^32
        movi s6, 6
        wextend w2, s6, 0
        wsqrt s7, w2, 0         ; s7 = 2 -- 2.449
        movi s6, 7
        wextend w2, s6, 0
        wsqrt s8, w2, 0         ; s8 = 3 -- 2.646
        wsqrt s9, w0, 0         ; s9 = 0
        wsqrt s10, w0, 63       ; s10 = 0
        movi s6, -1
        wextend w3, s6, 0
        wsqrt s11, w3, 0        ; s11 = 0 -- of a negative number
        wsqrt s12, w3, 63       ; s12 = 0
        li   s13, 0x7fffffff
        wjoin w4, s13, s6       ; w4 = 0x7fffffffffffffff
        wsqrt s14, w4, 0        ; s14 = 0x7fffffff -- 3037000499.97
        wsqrt s15, w4, 63       ; s15 = 0x7fffffff
        wmul w5, s13, s13
        wsqrt s16, w5, 0        ; s16 = 0x7fffffff
        wextend w6, s13, 0
        wsub w5, w5, w6         ; w5 = 0x7fffffff * 0x7ffffffe
        wsqrt s17, w5, 0        ; s17 = 0x7ffffffe -- r^2 - r is just below r - 1/2
        movi s6, 1
        wextend w6, s6, 0
        wadd w5, w5, w6
        wsqrt s18, w5, 0        ; s18 = 0x7fffffff -- r^2 - r + 1 just above
        li   s19, 0.5:dir
        wextend w7, s19, 0
        wsqrt s20, w7, 30       ; s20 = 0.7071067812:dir
        halt
