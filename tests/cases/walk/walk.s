; Two levels of a tree that divides x at 50 and then at 25, and a leaf of 3 triangles at 0x900, in a block; the right children lie elsewhere.
; The walk begins at its start (w2) and leaves by the plane x = 100, the only note.
        .buffer
block:  .word 0x400, 24
        .word 50, 0x408
        .word 25, 0x410
        .word 3, 0x903
notes:  .word 100, 0, 0
        .space 24
        .text
        movi  s1, 3
        wjoin w2, s1, s0
        movi  s5, block
        vset  v1, 0, 0, 0, s4
        vset  v2, 1, 1, 0, s4
        movi  s2, 0x400
        movi  s3, notes
        rwalk w1, s2, s3, v1, w2, s5    ; exit Leaf; w1 = 0x90300000003; s2 = 0x900
        vset  v1, 60, 0, 0, s4
        movi  s2, 0x400
        movi  s3, notes
        rwalk w1, s2, s3, v1, w2, s5    ; exit Leaf; s2 = 0x900 -- behind the first split
        vset  v2, -1, 1, 0, s4
        vset  v1, 30, 0, 0, s4
        movi  s2, 0x408
        movi  s3, notes
        rwalk w1, s2, s3, v1, w2, s5    ; exit Outside; s2 = 0x418 -- the child lies behind the block
        movi  s2, 0x3f8
        rwalk w1, s2, s3, v1, w2, s5    ; exit Outside; s2 = 0x3f8; w1 = 0
        sw    s0, 4(s5)
        movi  s2, 0x400
        rwalk w1, s2, s3, v1, w2, s5    ; exit Outside; s2 = 0x400 -- a block of no octets
        halt                            ; count: sub 18, mul 24, cmp 41, move 38, jump 1, local 51
