; Three triangles in planes across the ray, which starts at the origin and goes along z; of two at the same distance that with the least name.
        .buffer
packet: .word 7, 3, 5
        .word -10, -10, -10
        .word -10, -10, -10
        .word 40, 60, 40
        .word 30, 30, 30
        .word -10, -10, -10
        .word 40, 60, 40
        .word -10, -10, -10
        .word 30, 30, 30
        .word 40, 60, 40
        .text
        vset  v1, 0, 0, 0, s1
        vset  v2, 0, 0, 2, s1
        movi  s2, packet
        movi  s3, 3
        vset  v3, 1000, 0, 9, s1
        rnear v3, v1, s2, s3, 0         ; exit Nearer; v3 = 20, 5, 9
        rnear v3, v1, s2, s3, 0         ; exit Same; v3 = 20, 5, 9
        vset  v3, 20, 4, 0, s1
        rnear v3, v1, s2, s3, 0         ; exit Same; v3 = 20, 4, 0
        vset  v3, 20, -1, 0, s1
        rnear v3, v1, s2, s3, 0         ; exit Nearer; v3 = 20, 5, 0 -- names have no sign
        vset  v3, 1000, 0, 0, s1
        rnear v3, v1, s2, s3, 4         ; exit Nearer; v3 = 320, 5, 0
        vset  v3, 19, 0, 0, s1
        rnear v3, v1, s2, s3, 0         ; exit Same; v3 = 19, 0, 0
        vset  v3, 20, 3, 0, s1
        rnear v3, v1, s2, s0, 0         ; exit Same -- no triangle at all
        vset  v3, 1000, 0, 0, s1
        vset  v2, 0, 0, -2, s1
        rnear v3, v1, s2, s3, 0         ; exit Same; v3 = 1000, 0, 0
        halt                            ; count: add 210, sub 378, mul 630, div 21, cmp 92, move 59, jump 1, local 210
