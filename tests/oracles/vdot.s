; Three exact products, two exact sums, one rounding. Sums of 65 bits are beyond a wide accumulator.
; arithmetic: default
; range: a 30 bits
; range: b 30 bits
        .macro product wide, component
        vget s8, a, \component
        vget s9, b, \component
        wmul \wide, s8, s9
        .endm
        product w0, 0
        product w1, 1
        wadd w0, w0, w1
        product w1, 2
        wadd w0, w0, w1
        wround d, w0, i
