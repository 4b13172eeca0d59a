;; iadd
        li      s1, 0x7fffffff
        li      s2, 1
        iadd    s3, s1, s2              ; s3 = -2147483648
        halt

;; isub
        li      s1, 5
        li      s2, 8
        isub    s3, s1, s2              ; s3 = -3
        halt

;; imul
        li      s1, 1000
        li      s2, -3
        imul    s3, s1, s2              ; s3 = -3000
        halt

;; and
        li      s1, 0b1100
        li      s2, 0b1010
        and     s3, s1, s2              ; s3 = 8
        halt

;; or
        li      s1, 0b1100
        li      s2, 0b1010
        or      s3, s1, s2              ; s3 = 14
        halt

;; xor
        li      s1, 0b1100
        li      s2, 0b1010
        xor     s3, s1, s2              ; s3 = 6
        halt

;; sll
        li      s1, 3
        li      s2, 4
        sll     s3, s1, s2              ; s3 = 48
        halt

;; srl
        li      s1, -16
        li      s2, 28
        srl     s3, s1, s2              ; s3 = 15
        halt

;; sra
        li      s1, -16
        li      s2, 2
        sra     s3, s1, s2              ; s3 = -4
        halt

;; slt
        li      s1, -1
        li      s2, 1
        slt     s3, s1, s2              ; s3 = 1
        halt

;; clz
        li      s1, 1
        clz     s2, s1                  ; s2 = 31
        halt

;; mov
        li      s1, 42
        mov     s2, s1                  ; s2 = 42
        halt

;; addr
        li      s1, 0x100
        li      s2, -4
        addr    s3, s1, s2              ; s3 = 252
        halt

;; slli
        li      s1, 3
        slli    s2, s1, 4               ; s2 = 48
        halt

;; srli
        li      s1, -16
        srli    s2, s1, 28              ; s2 = 15
        halt

;; srai
        li      s1, -16
        srai    s2, s1, 2               ; s2 = -4
        halt

;; iaddi
        li      s1, 5
        iaddi   s2, s1, -8              ; s2 = -3
        halt

;; isubi
        li      s1, 5
        isubi   s2, s1, 8               ; s2 = -3
        halt

;; andi
        li      s1, 0x1234
        andi    s2, s1, 0xff            ; s2 = 52
        halt

;; ori
        li      s1, 0x1200
        ori     s2, s1, 0x34            ; s2 = 4660
        halt

;; movi
        movi    s1, -5                  ; s1 = -5
        halt

;; movhi
        movi    s1, 0x1234
        movhi   s1, 1                   ; s1 = 70196
        halt

;; lea
        li      s1, 0x100
        lea     s2, 8(s1)               ; s2 = 264
        halt

;; element
        li      s1, 0x100
        li      s2, 3
        element s3, s1, s2, 12          ; s3 = 292
        halt
