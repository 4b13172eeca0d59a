; Two triangles share the edge x = 0, the ray goes through it: exactly one is hit, that on the side of larger x.
        vset  v2, 0, 0, 1, s1
        vset  v3, 0, -5, 8, s1
        vset  v4, 9, 0, 8, s1
        vset  v5, 0, 5, 8, s1
        rtri  s2, v9, v1, v3, 0         ; exit Hit; s2 = 8; v9 = 0, 0x20000000, 0
        vset  v6, 0, 5, 8, s1
        vset  v7, -9, 0, 8, s1
        vset  v8, 0, -5, 8, s1
        rtri  s2, v9, v1, v6, 0         ; exit OutsideU; s2 = 0x7fffffff
; Backwards it is that on the side of smaller x.
        vset  v2, 0, 0, -1, s1
        vset  v1, 0, 0, 16, s1
        rtri  s2, v9, v1, v3, 0         ; exit Hit
        rtri  s2, v9, v1, v6, 0         ; exit OutsideU
; A triangle seen along one of its edges has no area for the ray.
        vset  v1, 0, -9, 8, s1
        vset  v2, 0, 1, 0, s1
        rtri  s2, v9, v1, v3, 0         ; exit Parallel
        halt                            ; count: add 26, sub 103, mul 105, div 6, cmp 25, move 66, jump 1
