; Five registers from v28 on do not exist; the assembler refuses them, and so does the decoder.
        .word 0b100110_00000_11100_00000_00000_000100 ; trap: the word 0x981c0004 is no instruction
