; A constant of 32 bits takes two words.
        movi s1, -32768         ; s1 = 0xffff8000
        movi s2, 32767          ; s2 = 32767
        movhi s2, 0x1234        ; s2 = 0x12347fff
        movhi s1, 0             ; s1 = 0x00008000
        movhi s3, 0xffff        ; s3 = 0xffff0000
        li   s4, 0xdeadbeef     ; s4 = 0xdeadbeef
        mov  s5, s4             ; s5 = 0xdeadbeef
        mov  s0, s4             ; s0 = 0
        movi s0, 5              ; s0 = 0
        movhi s0, 5             ; s0 = 0
        halt                    ; count: move 11, jump 1
