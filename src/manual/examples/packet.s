;; rnear
        .buffer
packet: .word   7
        .word   -10, -10, 40, 30, -10, 40, -10, 30, 40
        .text
        vset    v1, 0, 0, 0, s1
        vset    v2, 0, 0, 2, s1
        movi    s2, packet
        movi    s3, 1
        vset    v3, 1000, 0, 9, s1
        rnear   v3, v1, s2, s3, 0       ; exit Nearer; v3 = 20, 7, 9
        halt

;; rany
        .buffer
packet: .word   7
        .word   -10, -10, 40, 30, -10, 40, -10, 30, 40
        .text
        vset    v1, 0, 0, 0, s1
        vset    v2, 0, 0, 2, s1
        movi    s2, packet
        movi    s3, 1
        vset    v3, 31, 0, 9, s1
        rany    v3, v1, s2, s3, 0       ; exit Blocked; v3 = 20, 7, 9
        halt
