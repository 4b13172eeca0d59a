; Whether a hit is surely nearer than the plane y = -10.
        movi  s1, 1
        movi  s2, -10
        wjoin w1, s1, s2
        vset  v2, 0, -2, 0, s3
        movi  s4, 3
        rbefore s5, v1, w1, s4, 0       ; s5 = 1
        movi  s4, 4
        rbefore s5, v1, w1, s4, 0       ; s5 = 0 -- one unit further on it would be on the plane
        rbefore s5, v1, w1, s4, 1       ; s5 = 1 -- 4 / 2
        vset  v2, 0, 2, 0, s3
        movi  s4, 0
        rbefore s5, v1, w1, s4, 0       ; s5 = 0 -- behind
        movi  s4, -1
        rbefore s5, v1, w1, s4, 0       ; s5 = 0
        halt                            ; count: add 5, sub 10, mul 5, cmp 5, move 19, jump 1
