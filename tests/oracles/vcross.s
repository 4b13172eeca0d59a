; In each component two exact products, an exact difference and one rounding.
        .macro minor component, j, k
        vget s8, a, \j
        vget s9, b, \k
        wmul w0, s8, s9
        vget s8, a, \k
        vget s9, b, \j
        wmul w1, s8, s9
        wsub w0, w0, w1
        wround s8, w0, i
        vput d, s8, \component
        .endm
        minor 0, 1, 2
        minor 1, 2, 0
        minor 2, 0, 1
