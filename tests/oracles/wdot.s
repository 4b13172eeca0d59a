; Three exact products, two exact sums. Sums of 65 bits saturate here one after the other.
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
        wadd d, w0, w1
