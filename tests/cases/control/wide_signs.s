        movi s1, -1
        wextend w1, s1, 40
        movi s1, 1
        wextend w2, s1, 40
        bweqz w0, .+2           ; exit Taken
        trap 1
        bweqz w2, .+99          ; exit Fall
        bwnez w1, .+2           ; exit Taken
        trap 2
        bwnez w0, .+99          ; exit Fall
        bwltz w1, .+2           ; exit Taken
        trap 3
        bwltz w0, .+99          ; exit Fall
        bwgez w0, .+2           ; exit Taken
        trap 4
        bwgez w1, .+99          ; exit Fall
        bwlt w1, w2, .+2        ; exit Taken
        trap 5
        bwlt w2, w1, .+99       ; exit Fall
        bwlt w1, w1, .+99       ; exit Fall
        bweq w1, w1, .+2        ; exit Taken
        trap 6
        bweq w1, w2, .+99       ; exit Fall
        halt                    ; count: cmp 13, move 2, logic 2, jump 1
