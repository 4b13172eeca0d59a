; A node whose child stands in front of it ends the walk, so that no block can hold it for ever.
        .buffer
block:  .word 0x400, 16
        .word 50, 0x400
        .word 50, 0x3f8
notes:  .word 100, 0, 0
        .space 24
        .text
        movi  s1, 3
        wjoin w2, s1, s0
        movi  s5, block
        vset  v2, 1, 1, 0, s4
        movi  s2, 0x400
        movi  s3, notes
        rwalk w1, s2, s3, v1, w2, s5    ; exit Outside
        movi  s2, 0x408
        movi  s3, notes
        rwalk w1, s2, s3, v1, w2, s5    ; exit Outside
        halt
