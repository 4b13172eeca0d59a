; trap: the program counter left the program of 2 words
        nop
        nop
