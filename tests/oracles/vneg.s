; The negations of the components.
        .irp component, 0, 1, 2
        vget s8, a, \component
        neg  s8, s8
        vput d, s8, \component
        .endr
