        movi s1, 32768
        movi s1, -32769
        mul s1, s2, s3, 64
        ori s1, s2, -1
        lw s1, 40000(s2)
        vget s1, v2, 3
        li s1, 1 << 32
        li s1, -(1 << 31) - 1
        .buffer
        .byte 256, -129, 255
        .half 70000
        .word 1 << 32
