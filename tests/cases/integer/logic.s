; Constants of the logic are not extended with a sign.
        li   s1, 0xf0f0a5a5
        li   s2, 0x0ff01234
        and  s3, s1, s2         ; s3 = 0x00f00024
        or   s4, s1, s2         ; s4 = 0xfff0b7b5
        xor  s5, s1, s2         ; s5 = 0xff00b791
        andi s6, s1, 0xffff     ; s6 = 0xa5a5
        ori  s7, s1, 0xffff     ; s7 = 0xf0f0ffff
        andi s8, s1, 0          ; s8 = 0
        ori  s9, s0, 0x8000     ; s9 = 32768
        halt                    ; count: move 4, logic 7, jump 1
