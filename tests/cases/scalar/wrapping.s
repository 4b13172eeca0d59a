; WRAP keeps the low bits; a quotient by zero has none and saturates.
; machine: arithmetic.overflow = "WRAP"
        li   s1, 0x7fffffff
        li   s2, -0x80000000
        movi s3, 1
        add  s4, s1, s3         ; s4 = -0x80000000
        sub  s5, s2, s3         ; s5 = 0x7fffffff
        neg  s6, s2             ; s6 = -0x80000000
        abs  s7, s2             ; s7 = -0x80000000
        mul  s8, s1, s1, 0      ; s8 = 1 -- 2^62 - 2^32 + 1
        lshift s9, s3, 31       ; s9 = -0x80000000
        lshift s10, s3, 32      ; s10 = 0
        div  s11, s3, s0, 0     ; s11 = 0x7fffffff
        div  s12, s2, s0, 0     ; s12 = -0x80000000
        movi s13, -1
        div  s14, s2, s13, 0    ; s14 = -0x80000000
        halt
