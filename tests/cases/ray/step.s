; A node divides x at 50 and has its children at 0x400 and 0x408. The ray is between its start (w2) and the plane x = 100 (w3).
        movi  s1, 0x400
        movi  s2, 50
        wjoin w1, s1, s2
        movi  s3, 3
        wjoin w2, s3, s0
        movi  s3, 100
        wjoin w3, s0, s3
        vset  v1, 0, 0, 0, s4
        vset  v2, 1, 1, 0, s4
        rstep s5, s6, v1, w1, 8         ; exit Both; s5 = 0x400; s6 = 0x408
        vset  v1, 60, 0, 0, s4
        rstep s5, s6, v1, w1, 8         ; exit Behind; s5 = 0x408; s6 = 0
        vset  v1, 50, 0, 0, s4
        rstep s5, s6, v1, w1, 8         ; exit Behind; s5 = 0x408 -- through the origin
        vset  v2, -1, 1, 0, s4
        rstep s5, s6, v1, w1, 8         ; exit Behind; s5 = 0x400
        vset  v1, 150, 0, 0, s4
        rstep s5, s6, v1, w1, 8         ; exit Near; s5 = 0x408; s6 = 0 -- it leaves before
        movi  s3, 20
        wjoin w3, s0, s3
        rstep s5, s6, v1, w1, 8         ; exit Both; s5 = 0x408; s6 = 0x400
; Came by y = 100: x = 50 is met at the same time. Of the two x comes first where it goes to larger coordinates.
        movi  s2, 100
        movi  s3, 1
        wjoin w2, s3, s2
        rstep s5, s6, v1, w1, 8         ; exit Both; s5 = 0x408; s6 = 0x400
        vset  v1, -50, 0, 0, s4
        vset  v2, 1, 1, 0, s4
        rstep s5, s6, v1, w1, 8         ; exit Passed; s5 = 0x408; s6 = 0
; A leaf.
        movi  s1, 0x123
        wjoin w1, s1, s2
        rstep s5, s6, v1, w1, 8         ; exit Leaf; s5 = 0x120; s6 = -1
        halt                            ; count: sub 14, mul 18, cmp 35, move 59, jump 1
