; Address arithmetic has a class of its own and wraps at 2^32.
        movi s1, 1000
        movi s2, -10
        addr s3, s1, s2         ; s3 = 990
        addr s4, s2, s1         ; s4 = 990 -- 2^32 - 10 + 1000
        lea  s5, -32768(s1)     ; s5 = -31768
        lea  s6, 32767(s1)      ; s6 = 33767
        element s7, s1, s2, 31  ; s7 = 690
        element s8, s1, s1, 2047 ; s8 = 2048000
        element s9, s1, s1, 0   ; s9 = 1000
        li   s10, 0x7fffffff
        element s11, s1, s10, 2 ; s11 = 998 -- 1000 + 2^32 - 2
        halt                    ; count: move 4, jump 1, address 8
