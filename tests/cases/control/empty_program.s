; trap: the program counter left the program of 0 words
        .buffer
        .word 1
