; A loop that sums 1 to 4: the last claim beside a line is about its last pass.
        movi s1, 4
again:  iadd s2, s2, s1         ; s2 = 10
        isubi s1, s1, 1         ; s1 = 0
        bnez s1, again          ; exit Taken, Taken, Taken, Fall
        halt                    ; count: add 4, sub 4, cmp 4, move 1, jump 1; clocks: 12
