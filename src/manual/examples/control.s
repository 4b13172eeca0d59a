;; beq
        movi    s1, 5
        movi    s2, 5
        beq     s1, s2, 1f              ; exit Taken
        movi    s3, 1
1:      nop                             ; s3 = 0
        halt

;; bne
        movi    s1, 5
        movi    s2, 6
        bne     s1, s2, 1f              ; exit Taken
        movi    s3, 1
1:      nop                             ; s3 = 0
        halt

;; blt
        movi    s1, -1
        movi    s2, 1
        blt     s1, s2, 1f              ; exit Taken
        movi    s3, 1
1:      nop                             ; s3 = 0
        halt

;; bge
        movi    s1, 1
        movi    s2, -1
        bge     s1, s2, 1f              ; exit Taken
        movi    s3, 1
1:      nop                             ; s3 = 0
        halt

;; bltu
        movi    s1, 1
        movi    s2, -1
        bltu    s1, s2, 1f              ; exit Taken
        movi    s3, 1
1:      nop                             ; s3 = 0
        halt

;; bgeu
        movi    s1, -1
        movi    s2, 1
        bgeu    s1, s2, 1f              ; exit Taken
        movi    s3, 1
1:      nop                             ; s3 = 0
        halt

;; bweqz
        movi    s1, 0
        wextend w0, s1, 0
        bweqz   w0, 1f                  ; exit Taken
        movi    s3, 1
1:      nop                             ; s3 = 0
        halt

;; bwnez
        movi    s1, 5
        wextend w0, s1, 0
        bwnez   w0, 1f                  ; exit Taken
        movi    s3, 1
1:      nop                             ; s3 = 0
        halt

;; bwltz
        movi    s1, -5
        wextend w0, s1, 0
        bwltz   w0, 1f                  ; exit Taken
        movi    s3, 1
1:      nop                             ; s3 = 0
        halt

;; bwgez
        movi    s1, 5
        wextend w0, s1, 0
        bwgez   w0, 1f                  ; exit Taken
        movi    s3, 1
1:      nop                             ; s3 = 0
        halt

;; bwlt
        movi    s1, 5
        movi    s2, 6
        wextend w0, s1, 0
        wextend w1, s2, 0
        bwlt    w0, w1, 1f              ; exit Taken
        movi    s3, 1
1:      nop                             ; s3 = 0
        halt

;; bweq
        movi    s1, 5
        wextend w0, s1, 0
        wextend w1, s1, 0
        bweq    w0, w1, 1f              ; exit Taken
        movi    s3, 1
1:      nop                             ; s3 = 0
        halt

;; jump
        jump    1f                      ; exit Taken
        movi    s3, 1
1:      nop                             ; s3 = 0
        halt

;; call
        call    s31, twice              ; s31 = 1
        halt                            ; s1 = 2
        .func   twice
        movi    s1, 2
        ret     s31
        .endfunc

;; callr
        movi    s2, twice
        callr   s31, s2                 ; s31 = 2
        halt                            ; s1 = 2
        .func   twice
        movi    s1, 2
        ret     s31
        .endfunc

;; ret
        call    s31, twice
        halt                            ; s1 = 2
        .func   twice
        movi    s1, 2
        ret     s31                     ; exit Taken
        .endfunc

;; core
        core    s1                      ; s1 = 0
        halt

;; cores
        cores   s1                      ; s1 = 1
        halt

;; halt
        halt                            ; exit Done

;; trap
        trap    7                       ; trap: trap 7
