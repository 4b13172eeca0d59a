; Words of global memory at any octet.
        li   s1, 0x04030201
        movi s2, 10
        stw  s1, -3(s2)         ; memory[6] = 0, 1, 2, 3, 4, 0; clocks: 8
        ldw  s3, -4(s2)         ; s3 = 0x03020100; clocks: 16
        ldw  s4, 0(s2)          ; s4 = 4
        vset v1, 1, -1, 256, s5
        stv  v1, 20(s0)         ; memory[20] = 1, 0, 0, 0, 255, 255, 255, 255, 0, 1, 0, 0; clocks: 48
        halt                    ; count: mem 4, octet 24, move 9, jump 1
