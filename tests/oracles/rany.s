; One triangle after the other, up to the first one that is nearer than the limit.
; arithmetic: default
; range: a 10 bits
; range: x 12 bits
; buffer: packet of 10 bits
        .include "packet.inc"
        .buffer
        .space 512
        .text
        first_triangle
        vget s11, x, 0
next:   bgeu s8, s10, finished
        meet
        slt  s15, s27, s11
        slli s15, s15, 31
        movi s17, -1
        xor  s30, s30, s17
        and  s15, s15, s30
        bltz s15, found
        lea  s8, 4(s8)
        jump next
found:  lw   s14, (s8)
        vput x, s27, 0
        vput x, s14, 1
finished:
