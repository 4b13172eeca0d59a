; The ways in which the test of a triangle ends, in the order of its tests. The ray starts at the origin and goes along z.
        vset  v1, 0, 0, 0, s1
        vset  v2, 0, 0, 2, s1
        vset  v3, -10, -10, 40, s1
        vset  v4, 30, -10, 40, s1
        vset  v5, -10, 30, 40, s1
        rtri  s2, v6, v1, v3, 0         ; exit Hit; s2 = 20; v6 = 0x10000000, 0x10000000, 0 -- u = v = 1/4
        rtri  s2, v6, v1, v3, 4         ; exit Hit; s2 = 320
        vset  v4, -10, -10, 50, s1
        rtri  s2, v6, v1, v3, 0         ; exit Parallel; s2 = 0x7fffffff; v6 = 0, 0, 0
        vset  v4, -20, -10, 40, s1
        rtri  s2, v6, v1, v3, 0         ; exit OutsideU; s2 = 0x7fffffff
        vset  v4, 30, -10, 40, s1
        vset  v5, -10, -20, 40, s1
        rtri  s2, v6, v1, v3, 0         ; exit OutsideV
        vset  v5, -10, 3, 40, s1
        rtri  s2, v6, v1, v3, 0         ; exit OutsideW
        vset  v5, -10, 30, 40, s1
        vset  v2, 0, 0, -2, s1
        rtri  s2, v6, v1, v3, 0         ; exit Behind
        vset  v2, 0, 0, 2, s1
        vset  v1, 0, 0, 40, s1
        rtri  s2, v6, v1, v3, 0         ; exit Behind -- t = 0 is no hit
        vset  v1, 0, 0, 39, s1
        rtri  s2, v6, v1, v3, 0         ; exit Hit; s2 = 1 -- 1/2, to nearest
        halt                            ; count: add 58, sub 138, mul 183, div 9, cmp 61, move 87, jump 1
