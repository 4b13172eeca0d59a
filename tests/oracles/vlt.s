; Three comparisons, put side by side.
        mov  d, s0
        .irp component, 0, 1, 2
        vget s8, a, \component
        vget s9, b, \component
        slt  s8, s8, s9
        slli s8, s8, \component
        or   d, d, s8
        .endr
