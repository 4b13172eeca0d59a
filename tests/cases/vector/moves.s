; Copies take raw bits. Components are 0, 1, 2; component 3 reads zero and is nowhere.
        vset v1, 10, 20, 30, s1
        vmov v2, v1             ; v2 = 10, 20, 30
        movi s2, -7
        vsplat v3, s2           ; v3 = -7, -7, -7
        vget s3, v1, x          ; s3 = 10
        vget s4, v1, 2          ; s4 = 30
        vput v2, s2, y          ; v2 = 10, -7, 30
        movi s5, 1
        movi s6, 3
        movi s7, 6
        vgetr s8, v1, s5        ; s8 = 20
        vgetr s9, v1, s6        ; s9 = 0
        vgetr s10, v1, s7       ; s10 = 30 -- 6 modulo 4
        vgetr s11, v1, s2       ; s11 = 20 -- -7 modulo 4
        vputr v2, s2, s7        ; v2 = 10, -7, -7
        vputr v2, s5, s6        ; v2 = 10, -7, -7
        vputr v2, s6, s0        ; v2 = 3, -7, -7
        halt
