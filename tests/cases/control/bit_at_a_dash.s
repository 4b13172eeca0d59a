; A word with a bit where its picture has `-` is no instruction.
        .word 0x00000020        ; trap: the word 0x00000020 is no instruction -- `add` with a bit too many
