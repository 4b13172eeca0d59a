; The quotients of the components and a scalar.
        .irp component, 0, 1, 2
        vget s8, a, \component
        div  s8, s8, b, i
        vput d, s8, \component
        .endr
