        nop
        .word 0xffffffff        ; trap: the word 0xffffffff is no instruction; count: move 1
