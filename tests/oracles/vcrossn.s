; An exact cross product, moved so that its largest component has 30 bits. How far is looked up by the number of zero bits
; above the largest magnitude, which takes no arithmetic: for a negative component the complement has as many bits as the
; magnitude, except that of -2^k, which lacks one. The k bits below are all zero then, and that shows when the others
; are moved out.
; arithmetic: default
        .macro minor wide, j, k
        vget s8, a, \j
        vget s9, b, \k
        wmul w0, s8, s9
        vget s8, a, \k
        vget s9, b, \j
        wmul w1, s8, s9
        wsub \wide, w0, w1
        .endm
; Gathers, in s16 (high) and s17 (low), a pattern with as many bits as the largest magnitude.
        .macro gather wide
        whigh s8, \wide
        wlow s9, \wide
        srai s10, s8, 31
        xor  s11, s8, s10
        xor  s12, s9, s10
        or   s16, s16, s11
        or   s17, s17, s12
        wjoin w0, s11, s12      ; the complement, moved up over a 1: its highest bit is that of 2^k
        wsll w0, w0, s13
        wlow s11, w0
        ori  s11, s11, 1
        whigh s12, w0
        wjoin w0, s12, s11
        wclz s14, w0
        wsll w1, \wide, s13     ; 64 - k bits are moved out
        wsll w1, w1, s14
        wclz s14, w1
        srli s14, s14, 6        ; 1 when nothing is left
        slli s14, s14, 31
        srai s14, s14, 31
        and  s14, s14, s10
        and  s11, s11, s14
        and  s12, s12, s14
        or   s16, s16, s12
        or   s17, s17, s11
        .endm
        .buffer
shifts: .rept 65, zeros
        .half 34 - zeros
        .endr
        .text
        movi s13, 1
        minor w4, 1, 2
        minor w5, 2, 0
        minor w6, 0, 1
        gather w4
        gather w5
        gather w6
        wjoin w0, s16, s17
        wclz s8, w0
        element s8, s0, s8, 2
        lh   s8, shifts(s8)
        wscale s9, w4, s8
        vput d, s9, 0
        wscale s9, w5, s8
        vput d, s9, 1
        wscale s9, w6, s8
        vput d, s9, 2
