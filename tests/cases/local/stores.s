; Low octets only; what stands beside them stays.
        li   s1, 0x12345678
        movi s2, 8
        sw   s1, 0(s2)          ; buffer[7] = 0, 0x78, 0x56, 0x34, 0x12, 0
        sh   s1, -3(s2)         ; buffer[4] = 0, 0x78, 0x56, 0, 0x78
        sb   s1, 7(s2)          ; buffer[14] = 0, 0x78
        sw   s0, 1(s2)          ; buffer[8] = 0x78, 0, 0, 0, 0, 0, 0, 0x78
        sh   s1, 7(s2)          ; buffer[15] = 0x78, 0x56
        halt                    ; count: move 3, jump 1, local 5
        .buffer
        .space 20
