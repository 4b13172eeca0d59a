; The differences of the components.
        .irp component, 0, 1, 2
        vget s8, a, \component
        vget s9, b, \component
        sub  s8, s8, s9
        vput d, s8, \component
        .endr
