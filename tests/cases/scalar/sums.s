; Sums and differences saturate at both ends of the word.
        .format pos, 16
        li   s1, 0x7fffffff
        li   s2, -0x80000000
        movi s3, 1
        movi s4, -7
        add  s5, s3, s4         ; s5 = -6
        add  s6, s1, s3         ; s6 = 0x7fffffff; s6 = 32767.99998:pos
        add  s7, s2, s4         ; s7 = -0x80000000
        add  s8, s1, s2         ; s8 = -1
        sub  s9, s3, s4         ; s9 = 8
        sub  s10, s2, s3        ; s10 = -0x80000000
        sub  s11, s1, s4        ; s11 = 0x7fffffff
        sub  s12, s2, s2        ; s12 = 0
        sub  s13, s0, s2        ; s13 = 0x7fffffff
        add  s0, s1, s1         ; s0 = 0 -- s0 ignores what is written
        halt                    ; count: add 5, sub 5, move 6, jump 1
