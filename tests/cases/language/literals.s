; Literals of a format are rounded to the nearest, ties up.
        .format dir, 30
        .format half, 1
        li   s1, 0.5:dir        ; s1 = 1 << 29
        li   s2, 0.25:half      ; s2 = 1
        li   s3, -0.25:half     ; s3 = 0
        li   s4, 1e3:half       ; s4 = 2000
        lw   s5, fixed(s0)      ; s5 = 0.1:dir
        lw   s6, fixed + 4(s0)  ; s6 = -7
        halt
        .buffer
fixed:  .fixed dir, 0.1, -7 + 0
