strat:  beqz s1, start          ; error E003: `start` is not defined
        halt
