; SAT_SYM: the least number is minus the largest, also for a quotient by zero.
; machine: arithmetic.overflow = "SAT_SYM"
        li   s1, -0x7fffffff
        movi s2, 1
        li   s3, -0x80000000
        sub  s4, s1, s2         ; s4 = -0x7fffffff
        min  s5, s3, s2         ; s5 = -0x7fffffff
        neg  s6, s1             ; s6 = 0x7fffffff
        div  s7, s1, s0, 0      ; s7 = -0x7fffffff
        div  s8, s2, s0, 0      ; s8 = 0x7fffffff
        halt
