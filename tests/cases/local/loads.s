; Little-endian, any alignment, octets unsigned.
        li   s1, data
        lbu  s2, 0(s1)          ; s2 = 0xfe
        lbu  s3, 1(s1)          ; s3 = 0x7f
        lh   s4, 0(s1)          ; s4 = 0x7ffe
        lh   s5, 1(s1)          ; s5 = -0x7f81 -- 0x807f
        lhu  s6, 1(s1)          ; s6 = 0x807f
        lw   s7, 0(s1)          ; s7 = 0x01807ffe
        lw   s8, 3(s1)          ; s8 = 0x05040301
        lbu  s9, -1(s1)         ; s9 = 9
        movi s10, 2
        lw   s11, -2(s10)       ; s11 = 0x807ffe09
        lw   s0, 0(s1)          ; s0 = 0
        halt                    ; count: move 3, jump 1, local 10
        .buffer
        .byte 9
data:   .byte 0xfe, 0x7f, 0x80, 1
        .byte 3, 4, 5
