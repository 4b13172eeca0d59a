; One triangle after the other; of those at the same distance that with the least name.
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
        vget s12, x, 1
next:   bgeu s8, s10, finished
        meet
        lw   s14, (s8)
        slt  s15, s27, s11      ; nearer
        slt  s16, s11, s27      ; farther
        movi s17, 0
        movhi s17, 0x8000
        xor  s18, s14, s17
        xor  s19, s12, s17
        slt  s18, s18, s19      ; of a lower name
        slli s15, s15, 31
        slli s16, s16, 31
        slli s18, s18, 31
        movi s17, -1
        xor  s16, s16, s17
        and  s18, s18, s16
        or   s15, s15, s18
        xor  s30, s30, s17
        and  s15, s15, s30
        srai s15, s15, 31       ; all ones: it is the nearest so far
        xor  s16, s27, s11
        and  s16, s16, s15
        xor  s11, s11, s16
        xor  s16, s14, s12
        and  s16, s16, s15
        xor  s12, s12, s16
        lea  s8, 4(s8)
        jump next
finished:
        vput x, s11, 0
        vput x, s12, 1
