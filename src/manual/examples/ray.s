;; rtri
        .format pos, 16
        .format dir, 30
        .format t, 16
        vset    v1, 0.25:pos, 0.25:pos, 0, s1
        vset    v2, 0, 0, 1:dir, s1
        vset    v3, 0, 0, 2:pos, s1
        vset    v4, 1:pos, 0, 2:pos, s1
        vset    v5, 0, 1:pos, 2:pos, s1
        rtri    s2, v6, v1, v3, dir + t - pos; s2 = 2:t; exit Hit
        halt

;; rbox
        .format pos, 16
        .format dir, 30
        .format t, 16
        vset    v1, 0.25:pos, 0.25:pos, 0, s1
        vset    v2, 0, 0, 1:dir, s1
        vset    v3, 0, 0, 1:pos, s1
        vset    v4, 1:pos, 1:pos, 2:pos, s1
        rbox    w0, w1, v1, v3          ; w0 = 8590000128; w1 = 8590065664
        halt

;; rexit
        .format pos, 16
        .format dir, 30
        .format t, 16
        vset    v1, 0.25:pos, 0.25:pos, 0, s1
        vset    v2, 0, 0, 1:dir, s1
        vset    v3, 0, 0, 1:pos, s1
        vset    v4, 1:pos, 1:pos, 2:pos, s1
        rexit   w0, v1, v3              ; w0 = 8590065664
        halt

;; rstep
        .format pos, 16
        .format dir, 30
        .format t, 16
        vset    v1, 0.25:pos, 0.25:pos, 0, s1
        vset    v2, 0, 0, 1:dir, s1
        vset    v3, 0, 0, 1:pos, s1
        vset    v4, 1:pos, 1:pos, 2:pos, s1
        rbox    w1, w2, v1, v3
        li      s4, 4 << 3 | 2
        li      s5, 1.5:pos
        wjoin   w0, s4, s5
        rstep   s2, s3, v1, w0, 8       ; s2 = 32; s3 = 40
        halt

;; rbefore
        .format pos, 16
        .format dir, 30
        .format t, 16
        vset    v1, 0.25:pos, 0.25:pos, 0, s1
        vset    v2, 0, 0, 1:dir, s1
        vset    v3, 0, 0, 1:pos, s1
        vset    v4, 1:pos, 1:pos, 2:pos, s1
        rexit   w0, v1, v3
        li      s2, 1.5:t
        rbefore s3, v1, w0, s2, dir + t - pos; s3 = 1
        halt
