; SAT_ZERO: what does not fit becomes 0.
; machine: arithmetic.overflow = "SAT_ZERO"
        li   s1, 0x7fffffff
        movi s2, 1
        add  s3, s1, s2         ; s3 = 0
        add  s4, s1, s0         ; s4 = 0x7fffffff
        neg  s5, s1             ; s5 = -0x7fffffff
        sub  s6, s5, s2         ; s6 = -0x80000000
        sub  s7, s6, s2         ; s7 = 0
        halt
