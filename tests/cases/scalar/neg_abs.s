; The least number has no counterpart: its negation and its absolute value saturate.
        li   s1, -0x80000000
        movi s2, -5
        movi s3, 5
        neg  s4, s1             ; s4 = 0x7fffffff
        neg  s5, s2             ; s5 = 5
        neg  s6, s3             ; s6 = -5
        neg  s7, s0             ; s7 = 0
        abs  s8, s1             ; s8 = 0x7fffffff
        abs  s9, s2             ; s9 = 5
        abs  s10, s3            ; s10 = 5
        abs  s11, s0            ; s11 = 0
        halt                    ; count: sub 8, cmp 4, move 4, jump 1
