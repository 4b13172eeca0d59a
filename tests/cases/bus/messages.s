; A core may write to itself. What arrives first is taken first.
        vset v1, 1, 2, 3, s1
        vset v2, 4, 5, 6, s1
        send2 s0, v1            ; clocks: 48
        movi s9, 7
        recv2 v10, s9           ; v10 = 1, 2, 3; v11 = 4, 5, 6; s9 = 0
        vmov v3, v2
        vmov v5, v1
        send5 s0, v1            ; clocks: 168
        recv5 v20, s9           ; v20 = 1, 2, 3; v21 = 4, 5, 6; v22 = 4, 5, 6; v23 = 0, 0, 0; v24 = 1, 2, 3
        halt                    ; count: mem 2, octet 84, move 40, jump 1
