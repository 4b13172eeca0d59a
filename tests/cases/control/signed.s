; Signed and unsigned order differ where a number is negative.
        movi s1, -1
        movi s2, 1
        blt  s1, s2, .+2        ; exit Taken
        trap 1
        blt  s2, s1, .+99       ; exit Fall
        blt  s1, s1, .+99       ; exit Fall
        bge  s2, s1, .+2        ; exit Taken
        trap 2
        bge  s1, s1, .+2        ; exit Taken
        trap 3
        bge  s1, s2, .+99       ; exit Fall
        bltu s2, s1, .+2        ; exit Taken
        trap 4
        bltu s1, s2, .+99       ; exit Fall
        bltu s1, s1, .+99       ; exit Fall
        bgeu s1, s2, .+2        ; exit Taken
        trap 5
        bgeu s2, s2, .+2        ; exit Taken
        trap 6
        bgeu s2, s1, .+99       ; exit Fall
        halt                    ; count: cmp 12, move 2, jump 1
