; By zero a quotient saturates with the sign of the dividend, and 0 / 0 is 0.
        movi s1, 5
        movi s2, -5
        div  s3, s1, s0, 0      ; s3 = 0x7fffffff
        div  s4, s2, s0, 0      ; s4 = -0x80000000
        div  s5, s0, s0, 0      ; s5 = 0
        div  s6, s1, s0, 63     ; s6 = 0x7fffffff
        div  s7, s0, s0, 63     ; s7 = 0
        halt                    ; count: div 5, move 2, jump 1
