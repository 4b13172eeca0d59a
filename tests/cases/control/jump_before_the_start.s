; trap: the program counter left the program of 2 words
        nop
        jump .-2                ; exit Taken
