; Component by component, or by one scalar; each component is rounded once.
        .format dir, 30
        vset v1, 3, -3, 0x7fffffff, s1
        vset v2, 1, 1, 0x7fffffff, s1
        vmul v3, v1, v2, 0      ; v3 = 3, -3, 0x7fffffff
        vmul v4, v1, v2, 1      ; v4 = 2, -1, 0x7fffffff
        vmul v5, v1, v2, 31     ; v5 = 0, 0, 0x7ffffffe
        movi s2, 5
        vscale v6, v1, s2, 0    ; v6 = 15, -15, 0x7fffffff
        vscale v7, v1, s2, 1    ; v7 = 8, -7, 0x7fffffff
        li   s3, -0x80000000
        vscale v8, v1, s3, 31   ; v8 = -3, 3, -0x7fffffff
        vscale v9, v1, s3, 32   ; v9 = -1, 2, -0x3fffffff -- -1.5, 1.5, -2^30 + 0.5
        vset v10, 0.5:dir, -0.75:dir, 1:dir, s1
        vmul v11, v10, v10, 30  ; v11 = 0.25:dir, 0.5625:dir, 1:dir
        vscale v11, v10, s0, 0  ; v11 = 0, 0, 0
        halt
