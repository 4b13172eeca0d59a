; The component of the largest absolute value, of equal ones the first.
        vset v1, 5, -5, 5, s1
        vmajor s2, v1           ; s2 = 0
        vset v1, 4, -5, 5, s1
        vmajor s2, v1           ; s2 = 1
        vset v1, 4, -5, 6, s1
        vmajor s2, v1           ; s2 = 2
        vset v1, 0x7fffffff, 0, -0x80000000, s1
        vmajor s2, v1           ; s2 = 2
        vset v1, -6, 0, -6, s1
        vmajor s2, v1           ; s2 = 0
        vset v1, 0, 1, 0, s1
        vmajor s2, v1           ; s2 = 1
        vzero v1
        vmajor s2, v1           ; s2 = 0
        halt
