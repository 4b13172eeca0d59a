        movi s1, n
        .set n, 1
        .set n, 2
        .equ fixed, 1
        .set fixed, 2
here:   here = 5
