        movi s1, 5
        movi s2, 5
        beq  s1, s2, .+2        ; exit Taken
        trap 1
        beq  s1, s0, .+9        ; exit Fall
        bne  s1, s0, .+2        ; exit Taken
        trap 2
        bne  s1, s2, .+9        ; exit Fall
        beqz s0, .+2            ; exit Taken
        trap 3
        bnez s0, .+9            ; exit Fall
        halt                    ; count: cmp 6, move 2, jump 1
