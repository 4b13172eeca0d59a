; Three comparisons, put side by side.
        mov  d, s0
        .irp lane, 0, 1, 2
        vget s8, a, \lane
        vget s9, b, \lane
        slt  s8, s8, s9
        slli s8, s8, \lane
        or   d, d, s8
        .endr
