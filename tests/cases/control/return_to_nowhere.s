; trap: the program counter left the program of 2 words
        movi s1, -1
        ret  s1                 ; exit Taken
