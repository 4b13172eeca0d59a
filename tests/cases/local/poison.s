; What the program does not fill is poisoned.
        lw   s1, 2(s0)          ; s1 = 0xa5a50504
        lbu  s2, 18524(s0)      ; s2 = 0xa5
        halt
        .buffer
        .byte 0, 1, 4, 5
