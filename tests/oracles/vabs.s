; The larger of each lane and its negation.
        .irp lane, 0, 1, 2
        vget s8, a, \lane
        neg  s9, s8
        max  s8, s8, s9
        vput d, s8, \lane
        .endr
