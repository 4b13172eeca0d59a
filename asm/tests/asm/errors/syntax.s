        add s1 s2, s3
        add s1, s2,
        movi s1, (1 + 2
        movi s1, 1 +
        , s1
        movi s1, #5
        movi s1, 1 2
        .equ 5, 5
        lw s1, 4(5)
