; The quotients of the lanes and a scalar.
        .irp lane, 0, 1, 2
        vget s8, a, \lane
        div  s8, s8, b, i
        vput d, s8, \lane
        .endr
