; Where rays enter a box and leave it. A plane has its coordinate in the low half, its axis in the high one.
        vset  v3, -10, -20, -30, s1
        vset  v4, 10, 20, 30, s1
        vset  v1, 0, 0, 0, s1
        vset  v2, 3, -4, 5, s1
        rbox  w1, w2, v1, v3            ; exit Inside; w1 = 3 << 32; w2 = 10 -- x = 10
        rexit w3, v1, v3                ; w3 = 10
        vset  v2, 1, 2, 3, s1
        rexit w3, v1, v3                ; w3 = 10 -- three planes at once: x is the first
        vset  v2, -1, -2, -3, s1
        rexit w3, v1, v3                ; w3 = (2 << 32) + 0xffffffe2 -- backwards it is the last
        vset  v1, 0, 0, 50, s1
        rbox  w1, w2, v1, v3            ; exit Entered; w1 = (2 << 32) + 30; w2 = (1 << 32) + 0xffffffec
        vset  v2, 0, -8, -1, s1
        rbox  w1, w2, v1, v3            ; exit Missed; w1 = -1; w2 = -1
        vset  v2, 1, 0, 0, s1
        rbox  w1, w2, v1, v3            ; exit Beside; w1 = -1 -- a direction of 0 goes to larger coordinates
        vset  v2, 0, 0, 1, s1
        rbox  w1, w2, v1, v3            ; exit Beside; w1 = -1
        halt                            ; count: sub 24, mul 36, cmp 52, move 57, jump 1
