        mul s1, s2, s3
        add s1, s2, s3, s4
        lw s1
        halt s1
        li s1
        nop s1
        lw s1, 8(s2), 4
