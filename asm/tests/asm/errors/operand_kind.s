        vadd v1, v2, s3
        add s1, s2, 4
        lw s1, 8(v2)
        movi s1, s2
        beq s1, s2, s3
        add s1, s2, 8(s3)
        li 5, 5
        .reg total, s5
        movi s1, total + 1
        mov s1, totl
