; One node after the other. Each costs the same: where the ray goes is found by logic, and what is not noted is written elsewhere.
; range: a 10 bits
; range: b planes 10 bits
; buffer: block of 10 bits
        .include "order.inc"
        .buffer
        .space 512
nowhere: .space 12
        .text
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
        lw   s8, (c)
        movi s9, -1
        xor  s8, s8, s9
        lea  s8, 1(s8)          ; the first node's address, negative
        lw   s9, 4(c)
        lea  s9, -8(s9)
        lea  s10, 8(c)
next:   addr s11, x, s8
        bltu s9, s11, outside
        addr s12, s10, s11
        lwide w0, (s12)
        lwide w1, (y)
        plane s14, s15, s16, w0
        plane s19, s20, s21, b
        plane s22, s23, s13, w1
        order s17, s19, s20, s21, s14, s15, s16
        order s18, s14, s15, s16, s22, s23, s13
        srai s19, s16, 31       ; all ones: backwards
        mov  s20, s0
        mov  s21, s15
        exchange s20, s21, s19
        slt  s20, s20, s21
        slli s20, s20, 31
        srai s20, s20, 31
        and  s17, s17, s20      ; the split lies ahead, behind the plane that the ray came by
        and  s18, s18, s17      ; and in front of the one that it leaves by: both sides
        srli s20, s14, 1
        and  s20, s20, s14
        slli s20, s20, 31
        srai s20, s20, 31       ; a leaf
        movi s21, -1
        xor  s22, s20, s21
        and  s18, s18, s22
        xor  s17, s17, s19
        xor  s17, s17, s21      ; the first child is the right one
        whigh s15, w0
        xor  s15, s15, s14      ; the left child
        andi s22, s17, 8
        addr s22, s15, s22      ; the first child
        xor  s17, s17, s21
        andi s23, s17, 8
        addr s23, s15, s23      ; the second one
        movi s16, nowhere
        lea  s13, 12(y)
        choose s16, s13, s16, s18
        wlow s13, w0
        wjoin w5, s14, s13
        swide w5, (s16)
        sw   s23, 8(s16)
        andi s13, s18, 12
        addr y, y, s13
        movi s13, 0
        movhi s13, 0x8000
        xor  s16, x, s13
        xor  s13, s22, s13
        slt  s13, s16, s13      ; the child stands behind its parent
        slli s13, s13, 31
        srai s13, s13, 31
        xor  s13, s13, s21
        or   s13, s13, s20
        bnez s13, ended
        mov  x, s22
        jump next
ended:  bnez s20, leaf
        mov  x, s22
        wextend d, s0, 0
        jump finished
leaf:   mov  x, s15
        wmov d, w0
        jump finished
outside:
        wextend d, s0, 0
finished:
