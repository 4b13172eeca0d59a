;; wmul
        li      s1, 100000
        li      s2, -300000
        wmul    w0, s1, s2              ; w0 = -30000000000
        halt

;; wmac
        li      s1, 100000
        li      s2, -300000
        wmul    w0, s1, s1
        wmac    w0, s1, s2              ; w0 = -20000000000
        halt

;; wmsub
        li      s1, 100000
        li      s2, -300000
        wmul    w0, s1, s1
        wmsub   w0, s1, s2              ; w0 = 40000000000
        halt

;; wdot
        vset    v1, 1, 2, 3, s1
        vset    v2, 4, 5, 6, s1
        wdot    w0, v1, v2              ; w0 = 32
        halt

;; wadd
        movi    s1, 12
        movi    s2, 10
        wextend w0, s1, 0
        wextend w1, s2, 0
        wadd    w2, w0, w1              ; w2 = 22
        halt

;; wsub
        movi    s1, 12
        movi    s2, 10
        wextend w0, s1, 0
        wextend w1, s2, 0
        wsub    w2, w0, w1              ; w2 = 2
        halt

;; wmulw
        movi    s1, 12
        movi    s2, 10
        wextend w0, s1, 0
        wextend w1, s2, 0
        wmulw   w2, w0, w1              ; w2 = 120
        halt

;; wneg
        movi    s1, -12
        wextend w0, s1, 0
        wneg    w1, w0                  ; w1 = 12
        halt

;; wmov
        movi    s1, -12
        wextend w0, s1, 0
        wmov    w1, w0                  ; w1 = -12
        halt

;; wextend
        movi    s1, 3
        wextend w0, s1, 40              ; w0 = 3298534883328
        halt

;; wround
        movi    s1, 7
        wextend w0, s1, 0
        wround  s2, w0, 1               ; s2 = 4
        halt

;; wscale
        movi    s1, 40
        movi    s2, -2
        wextend w0, s1, 0
        wscale  s3, w0, s2              ; s3 = 160
        halt

;; wdiv
        movi    s1, 3
        movi    s2, 4
        wextend w0, s1, 0
        wextend w1, s2, 0
        wdiv    s3, w0, w1, 16          ; s3 = 49152
        halt

;; wsqrt
        li      s1, 1000000
        wextend w0, s1, 0
        wsqrt   s2, w0, 0               ; s2 = 1000
        halt

;; wand
        movi    s1, 12
        movi    s2, 10
        wextend w0, s1, 0
        wextend w1, s2, 0
        wand    w2, w0, w1              ; w2 = 8
        halt

;; wsll
        movi    s1, 3
        movi    s2, 40
        wextend w0, s1, 0
        wsll    w1, w0, s2              ; w1 = 3298534883328
        halt

;; wsrl
        movi    s1, 3
        movi    s2, 38
        wextend w0, s1, 40
        wsrl    w1, w0, s2              ; w1 = 12
        halt

;; wclz
        movi    s1, 1
        wextend w0, s1, 0
        wclz    s2, w0                  ; s2 = 63
        halt

;; wltz
        movi    s1, -12
        wextend w0, s1, 0
        wltz    w1, w0                  ; w1 = -1
        halt

;; wlow
        movi    s1, 5
        movi    s2, 6
        wjoin   w0, s1, s2
        wlow    s3, w0                  ; s3 = 6
        halt

;; whigh
        movi    s1, 5
        movi    s2, 6
        wjoin   w0, s1, s2
        whigh   s3, w0                  ; s3 = 5
        halt

;; wjoin
        movi    s1, 1
        movi    s2, 2
        wjoin   w0, s1, s2              ; w0 = 4294967298
        halt

;; wcross
        vset    v1, 1, 0, 0, s1
        vset    v2, 0, 1, 0, s1
        wcross  w0, v1, v2              ; w0 = 0; w1 = 0; w2 = 1
        halt

;; wmixed
        vset    v1, 1, 0, 0, s1
        vset    v2, 0, 1, 0, s1
        vset    v3, 4, 5, 6, s1
        wcross  w0, v1, v2
        wmixed  w3, w0, v3, 0           ; w3 = 6
        halt
