; Words of 8 bits do not concern the integers.
; machine: arithmetic.word = 8
; machine: arithmetic.overflow = "SAT_ZERO"
        li   s1, 1000000        ; s1 = 1000000
        iadd s2, s1, s1         ; s2 = 2000000
        mov  s3, s2             ; s3 = 2000000
        lea  s4, 4(s3)          ; s4 = 2000004
        imul s5, s1, s1         ; s5 = 1000000 * 1000000 & 0xffffffff
        add  s6, s1, s0         ; s6 = 0 -- a numeric row
        halt
