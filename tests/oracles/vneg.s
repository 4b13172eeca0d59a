; The negations of the lanes.
        .irp lane, 0, 1, 2
        vget s8, a, \lane
        neg  s8, s8
        vput d, s8, \lane
        .endr
