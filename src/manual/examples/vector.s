;; vadd
        vset    v1, 1, 2, 3, s1
        vset    v2, 10, 20, 30, s1
        vadd    v3, v1, v2              ; v3 = 11, 22, 33
        halt

;; vsub
        vset    v1, 1, 2, 3, s1
        vset    v2, 10, 20, 30, s1
        vsub    v3, v1, v2              ; v3 = -9, -18, -27
        halt

;; vneg
        vset    v1, 1, -2, 3, s1
        vneg    v2, v1                  ; v2 = -1, 2, -3
        halt

;; vabs
        vset    v1, 1, -2, 3, s1
        vabs    v2, v1                  ; v2 = 1, 2, 3
        halt

;; vmin
        vset    v1, 1, 5, 3, s1
        vset    v2, 4, 2, 3, s1
        vmin    v3, v1, v2              ; v3 = 1, 2, 3
        halt

;; vmax
        vset    v1, 1, 5, 3, s1
        vset    v2, 4, 2, 3, s1
        vmax    v3, v1, v2              ; v3 = 4, 5, 3
        halt

;; vmul
        vset    v1, 3, 4, 5, s1
        vset    v2, 2, 2, 2, s1
        vmul    v3, v1, v2, 1           ; v3 = 3, 4, 5
        halt

;; vscale
        .format pos, 16
        vset    v1, 1:pos, 2:pos, -4:pos, s1
        li      s2, 0.5:pos
        vscale  v2, v1, s2, pos         ; v2 = 0.5:pos, 1:pos, -2:pos
        halt

;; vdiv
        .format pos, 16
        vset    v1, 1:pos, 2:pos, -4:pos, s1
        li      s2, 4:pos
        vdiv    v2, v1, s2, pos         ; v2 = 0.25:pos, 0.5:pos, -1:pos
        halt

;; vdot
        .format pos, 16
        vset    v1, 1:pos, 2:pos, 3:pos, s1
        vset    v2, 0.5:pos, 0:pos, 2:pos, s1
        vdot    s4, v1, v2, pos         ; s4 = 6.5:pos
        halt

;; vcross
        .format pos, 16
        vset    v1, 1:pos, 0, 0, s1
        vset    v2, 0, 1:pos, 0, s1
        vcross  v3, v1, v2, pos         ; v3 = 0, 0, 1:pos
        halt

;; vcrossn
        vset    v1, 3, 0, 0, s1
        vset    v2, 0, 5, 0, s1
        vcrossn v3, v1, v2              ; v3 = 0, 0, 1006632960
        halt

;; vnorm
        vset    v1, 3, 4, 0, s1
        vnorm   v2, s2, v1              ; v2 = 402653184, 536870912, 0; s2 = -27
        halt

;; vmov
        vset    v1, 1, 2, 3, s1
        vmov    v2, v1                  ; v2 = 1, 2, 3
        halt

;; vsplat
        movi    s1, 7
        vsplat  v1, s1                  ; v1 = 7, 7, 7
        halt

;; vget
        vset    v1, 4, 5, 6, s1
        vget    s2, v1, y               ; s2 = 5
        halt

;; vgetr
        vset    v1, 4, 5, 6, s1
        movi    s2, 2
        vgetr   s3, v1, s2              ; s3 = 6
        halt

;; vput
        movi    s1, 9
        vput    v1, s1, z               ; v1 = 0, 0, 9
        halt

;; vputr
        movi    s1, 9
        movi    s2, 1
        vputr   v1, s1, s2              ; v1 = 0, 9, 0
        halt

;; vmajor
        vset    v1, 4, -7, 6, s1
        vmajor  s2, v1                  ; s2 = 1
        halt

;; vlt
        vset    v1, 1, 5, 3, s1
        vset    v2, 4, 2, 9, s1
        vlt     s2, v1, v2              ; s2 = 5
        halt

;; vselect
        vset    v1, 7, 8, 9, s1
        vset    v2, 1, 2, 3, s1
        movi    s2, 0b101
        vselect v2, v1, s2              ; v2 = 7, 2, 9
        halt
