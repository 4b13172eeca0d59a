;; rwalk
        .buffer
block:  .word   0x400, 24
        .word   50, 0x408, 25, 0x410, 3, 0x903
notes:  .word   100, 0, 0
        .space  24
        .text
        movi    s1, 3
        wjoin   w2, s1, s0
        movi    s5, block
        vset    v1, 0, 0, 0, s4
        vset    v2, 1, 1, 0, s4
        movi    s2, 0x400
        movi    s3, notes
        rwalk   w1, s2, s3, v1, w2, s5  ; exit Leaf; w1 = 0x90300000003; s2 = 0x900
        halt
