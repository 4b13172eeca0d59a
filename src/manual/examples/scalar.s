;; add
        .format pos, 16
        li      s1, 1.5:pos
        li      s2, 2.25:pos
        add     s3, s1, s2              ; s3 = 3.75:pos
        halt

;; sub
        .format pos, 16
        li      s1, 1.5:pos
        li      s2, 2.25:pos
        sub     s3, s1, s2              ; s3 = -0.75:pos
        halt

;; neg
        .format pos, 16
        li      s1, 1.5:pos
        neg     s2, s1                  ; s2 = -1.5:pos
        halt

;; abs
        .format pos, 16
        li      s1, -1.5:pos
        abs     s2, s1                  ; s2 = 1.5:pos
        halt

;; mul
        .format pos, 16
        li      s1, 1.5:pos
        li      s2, -2.5:pos
        mul     s3, s1, s2, pos         ; s3 = -3.75:pos
        halt

;; div
        .format pos, 16
        li      s1, 3:pos
        li      s2, 4:pos
        div     s3, s1, s2, pos         ; s3 = 0.75:pos
        halt

;; min
        .format pos, 16
        li      s1, 1.5:pos
        li      s2, -2:pos
        min     s3, s1, s2              ; s3 = -2:pos
        halt

;; max
        .format pos, 16
        li      s1, 1.5:pos
        li      s2, -2:pos
        max     s3, s1, s2              ; s3 = 1.5:pos
        halt

;; rshift
        li      s1, 7
        rshift  s2, s1, 1               ; s2 = 4
        halt

;; lshift
        li      s1, 7
        lshift  s2, s1, 4               ; s2 = 112
        halt

;; scale
        li      s1, 40
        li      s2, -2
        scale   s3, s1, s2              ; s3 = 160
        halt
