; Three products, two sums, one rounding; products of 96 bits and results of more than 32 are beyond the elementary rows.
; arithmetic: default
; range: a 34 bits
; range: b 26 bits
; range: i 31..63
        .macro product wide, components, component
        vget s8, b, \component
        wextend \wide, s8, 0
        wmulw \wide, \wide, \components
        .endm
        product w0, w1, 0
        product w5, w2, 1
        wadd w0, w0, w5
        product w5, w3, 2
        wadd w0, w0, w5
        wround s8, w0, i
        wextend d, s8, 0
