; A claim beside a call is not about the lines of the macro; those are about all their calls.
        .macro twice register
        iadd \register, \register, \register ; exit Done, Done
        .endm
        movi s1, 3
        movi s2, 5
        twice s1
        twice s2
        mov  s3, s1             ; s3 = 6
        mov  s4, s2             ; s4 = 10
        .rept 3, k
        iaddi s5, s5, k
        .endr
        mov  s6, s5             ; s6 = 3
        halt                    ; count: add 5, move 5, jump 1
