; The run in the ray's direction, the slope without its sign, t slope + slope, and a comparison.
; range: a 20 bits
; range: b planes 20 bits
; range: c 20 bits
; range: i 0..15
; arithmetic: default
        whigh s8, b
        andi s8, s8, 3
        vgetr s9, v1, s8
        vgetr s10, v2, s8
        srli s11, s8, 1
        and  s11, s11, s8
        or   s10, s10, s11      ; time has slope 1
        srai s11, s10, 31
        wlow s12, b
        xor  s13, s9, s12
        and  s13, s13, s11
        xor  s9, s9, s13
        xor  s12, s12, s13
        sub  s12, s12, s9
        xor  s10, s10, s11
        isub s10, s10, s11
        wmul w0, c, s10
        wextend w1, s10, 0
        wadd w0, w0, w1
        wextend w1, s12, i
        movi d, 1
        bwlt w0, w1, 1f
        mov  d, s0
1:
