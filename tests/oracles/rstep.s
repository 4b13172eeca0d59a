; One comparison with the origin, then the order of the planes: the split after the one that the ray came by, and before the one that it
; leaves by. Of the planes that bound the way both are met, so the runs are those of a ray that goes on.
; range: a 10 bits
; range: b planes 10 bits
; range: i 0..31
        .include "order.inc"
; Axis, run and slope of a plane; time has origin 0 and slope 1.
        .macro plane axis, run, slope, pattern
        whigh \axis, \pattern
        andi \axis, \axis, 3
        vgetr s27, v1, \axis
        wlow \run, \pattern
        sub  \run, \run, s27
        vgetr \slope, v2, \axis
        srli s27, \axis, 1
        and  s27, s27, \axis
        or   \slope, \slope, s27
        .endm
        whigh s8, w2
        andi s9, s8, 3
        xor  s8, s8, s9         ; the left child
        mov  d, s8
        movi e, -1
        movi s10, 3
        beq  s9, s10, finished
        mov  e, s0
        lea  s10, i(s8)         ; the right child
        vgetr s11, v2, s9
        srai s11, s11, 31       ; all ones: backwards
        vgetr s12, v1, s9
        wlow s13, w2
        exchange s12, s13, s11
        choose d, s8, s10, s11  ; the far child
        bge  s12, s13, finished
        plane s14, s15, s16, w3
        plane s9, s12, s13, w2
        order s17, s14, s15, s16, s9, s12, s13
        beqz s17, finished
        choose d, s10, s8, s11  ; the near child
        plane s14, s15, s16, w4
        order s17, s9, s12, s13, s14, s15, s16
        beqz s17, finished
        choose e, s8, s10, s11
finished:
