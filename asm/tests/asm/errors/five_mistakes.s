; five different mistakes, one run
start:  vdto  s4, v1, v2, 16
        movi  s1, 40000
        add   s32, s1, s2
        beqz  s1, strat
        .wrod 5
        halt
