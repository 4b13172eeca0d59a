; A bit a component, component 0 lowest.
        vset v1, 1, 2, 3, s1
        vset v2, 2, 2, 2, s1
        vlt  s2, v1, v2         ; s2 = 1
        vlt  s3, v2, v1         ; s3 = 4
        vlt  s4, v1, v1         ; s4 = 0
        vset v3, -0x80000000, -1, 0, s1
        vlt  s5, v3, v1         ; s5 = 7
        vset v4, 100, 200, 300, s1
        vmov v5, v1
        vselect v5, v4, s3      ; v5 = 1, 2, 300
        movi s6, -5
        vselect v5, v4, s6      ; v5 = 100, 200, 300 -- the low bits of -5 are 011
        vselect v5, v1, s0      ; v5 = 100, 200, 300
        halt
