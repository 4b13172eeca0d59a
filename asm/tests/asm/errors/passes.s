        .rept   3, k
        movi    s1, 100 / (2 - k)
        .endr
        .irp    r, s1, q7
        mov     \r, s0
        .endr
