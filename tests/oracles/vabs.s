; The larger of each component and its negation.
        .irp component, 0, 1, 2
        vget s8, a, \component
        neg  s9, s8
        max  s8, s8, s9
        vput d, s8, \component
        .endr
