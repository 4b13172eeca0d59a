; The first triangle of a packet that is nearer than a limit; what stands behind it costs nothing.
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
        vset  v3, 31, 0, 9, s1
        rany  v3, v1, s2, s3, 0         ; exit Blocked; v3 = 20, 7, 9
        rany  v3, v1, s2, s3, 0         ; exit Clear; v3 = 20, 7, 9 -- none is nearer
        vset  v1, 0, 0, 50, s1
        vset  v3, 31, 0, 9, s1
        rany  v3, v1, s2, s3, 0         ; exit Blocked; v3 = 5, 3, 9
        rany  v3, v1, s2, s0, 0         ; exit Clear
        halt                            ; count: add 60, sub 108, mul 180, div 6, cmp 20, move 29, jump 1, local 60
