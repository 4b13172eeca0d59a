; In each component two exact products and an exact difference.
        .macro minor wide, j, k
        vget s8, a, \j
        vget s9, b, \k
        wmul w0, s8, s9
        vget s8, a, \k
        vget s9, b, \j
        wmul w1, s8, s9
        wsub \wide, w0, w1
        .endm
        minor w4, 1, 2
        minor w5, 2, 0
        minor w6, 0, 1
