        later s1
        .macro later a
        .endm
        li s1, 1:late
        .if 1:late
        .endif
        .buffer
        .fixed late, 1
        .format late, 4
        .word 1:late
