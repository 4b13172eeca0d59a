; Integer rows compute modulo 2^32 and never saturate.
        li   s1, 0x7fffffff
        movi s2, 1
        li   s3, -0x80000000
        iadd s4, s1, s2         ; s4 = -0x80000000
        isub s5, s3, s2         ; s5 = 0x7fffffff
        imul s6, s1, s1         ; s6 = 1 -- 2^62 - 2^32 + 1
        imul s7, s1, s3         ; s7 = -0x80000000
        iaddi s8, s1, -32768    ; s8 = 0x7fff7fff
        iaddi s9, s1, 32767     ; s9 = 0x80007ffe
        isubi s10, s3, 1        ; s10 = 0x7fffffff
        isubi s11, s0, -32768   ; s11 = 32768
        iadd s0, s1, s1         ; s0 = 0
        halt                    ; count: add 4, sub 3, mul 2, move 5, jump 1
