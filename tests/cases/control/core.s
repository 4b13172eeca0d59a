; Alone, a core has number 0 of 1.
        movi s1, 9
        movi s2, 9
        core s1                 ; s1 = 0
        cores s2                ; s2 = 1
        halt                    ; count: move 4, jump 1
