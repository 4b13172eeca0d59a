; The differences of the lanes.
        .irp lane, 0, 1, 2
        vget s8, a, \lane
        vget s9, b, \lane
        sub  s8, s8, s9
        vput d, s8, \lane
        .endr
