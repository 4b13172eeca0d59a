; A quotient is that of the exact numbers, rounded once to the nearest, ties up.
        movi s1, 7
        movi s2, 2
        movi s3, -7
        movi s4, -2
        div  s5, s1, s2, 0      ; s5 = 4 -- 3.5
        div  s6, s3, s2, 0      ; s6 = -3 -- -3.5
        div  s7, s1, s4, 0      ; s7 = -3
        div  s8, s3, s4, 0      ; s8 = 4
        div  s9, s2, s1, 0      ; s9 = 0 -- 0.29
        div  s10, s2, s1, 4     ; s10 = 5 -- 4.57
        div  s11, s4, s1, 4     ; s11 = -5
        div  s12, s2, s1, 30    ; s12 = 306783378 -- 306783378.29
        div  s13, s2, s1, 33    ; s13 = 0x7fffffff
        div  s14, s4, s1, 33    ; s14 = -0x80000000
        div  s15, s2, s1, 63    ; s15 = 0x7fffffff
        li   s16, -0x80000000
        movi s17, -1
        div  s18, s16, s17, 0   ; s18 = 0x7fffffff
        div  s19, s17, s16, 30  ; s19 = 1 -- 0.5
        div  s20, s2, s16, 29   ; s20 = 0 -- -0.5
        div  s21, s2, s16, 63   ; s21 = -0x80000000 -- -2^33
        halt                    ; count: div 15, move 7, jump 1
