; The address comes from the register as it was before.
        movi s1, 4
        lwp  s2, 4(s1)          ; s2 = 2; s1 = 8
        lwp  s3, -8(s1)         ; s3 = 3; s1 = 0
        lwp  s4, 0(s1)          ; s4 = 1; s1 = 0
        lvp  v1, 12(s1)         ; v1 = 1, 2, 3; s1 = 12
        swp  s3, 4(s1)          ; buffer[12] = 3, 0, 0, 0; s1 = 16
        swp  s1, 4(s1)          ; buffer[16] = 16, 0, 0, 0; s1 = 20
        lwp  s5, 4(s0)          ; s5 = 1; s0 = 0
        halt                    ; count: move 1, jump 1, local 9, address 7
        .buffer
        .word 1, 2, 3, 4, 5
