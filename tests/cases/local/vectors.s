; Three words in the order of the components.
        movi s1, 2
        lv   v1, 1(s1)          ; v1 = 0x04030201, -1, 0x7fffffff
        sv   v1, 14(s1)         ; buffer[15] = 0, 1, 2, 3, 4, 255, 255, 255, 255, 255, 255, 255, 127, 0
        lv   v2, 10(s1)         ; v2 = 0x007fffff, 0x04030201, -1
        halt                    ; count: move 1, jump 1, local 9
        .buffer
        .byte 9, 9, 9
        .word 0x04030201, 0xffffffff, 0x7fffffff
        .space 17
