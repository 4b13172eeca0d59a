; Distances count from the instruction itself, forward and back.
        jump over               ; exit Taken
back:   movi s1, 1              ; s1 = 1
        jump done               ; exit Taken
over:   jump back               ; exit Taken
        trap 1
done:   halt                    ; count: move 1, jump 4
