; Nodes of three and four bits, an octet each. Node 16 is a leaf of 2 triangles whose references begin at 24, node 17 divides x at -4 and has
; the left child 2.
        li    s1, 0x447a
        stw   s1, 16(s0)
        movi  s2, 128
        ldnode w0, s2, 3, 4             ; w0 = 115964116994
        movi  s3, 2
        movi  s4, 100
        loadnode s4, s2, s3, 3, 4
        lw    s5, 100(s0)               ; s5 = 2
        lw    s6, 104(s0)               ; s6 = 27
        lw    s7, 108(s0)               ; s7 = -4
        lw    s8, 112(s0)               ; s8 = 16
        halt
