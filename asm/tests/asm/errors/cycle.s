        .equ a, b + 1
        .equ b, c
        .equ c, a - 1
        .equ own, own
        movi s1, a
