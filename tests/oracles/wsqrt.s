; The root by a table of reciprocal roots, a Newton step, a step with the exact remainder, and an exact correction.
; No branch: every operand takes the same operations.
; arithmetic: default
        .struct scaling
        .field left, 1          ; 2^left a lies in [2^60, 2^62)
        .field half, 1          ; the root of that is to be divided by 2^half
        .field right, 1         ; twice as much: a 2^i again
        .field unused, 1
        .field keep, 4          ; and, or: what is known of the result beforehand
        .field known, 4
        .endstruct
        .buffer
; By the number of zero bits above a: 0 when it is negative, 64 when it is 0.
scalings:
        .rept 65, zeros
        .if zeros == 0 || zeros == 64
        .byte 0, 0, 0, 0
        .word 0, 0
        .elseif zeros < i + 2
        .byte 0, 0, 0, 0
        .word 0, 0x7fffffff
        .else
        .set half, (zeros - i - 2) / 2
        .byte i + 2 * half, half, 2 * half, 0
        .word -1, 0
        .endif
        .endr
; 2^15 / sqrt(m), m the middle of the interval [k, k + 1) / 1024 for k from 256; by Newton's method from one to the next.
roots:  .set root, 65472
        .rept 768, k
        .set square, (1 << 41) / (2 * (256 + k) + 1)
        .set root, (root + square / root) / 2
        .set root, (root + square / root) / 2
        .half root
        .endr
        .text
        wclz s8, a
        element s8, s0, s8, sizeof(scaling)
        lbu  s9, scalings + scaling.left(s8)
        wsll w0, a, s9          ; m 2^62, m in [1/4, 1)
        whigh s9, w0
        srli s9, s9, 20
        element s9, s0, s9, 2
        lhu  s9, roots - 512(s9) ; y = 1 / sqrt(m) to 10 bits, 15 fraction bits
        wround s10, w0, 31      ; m, 31 fraction bits
        mul  s11, s9, s9, 2     ; y y, 28 fraction bits
        mul  s11, s11, s10, 31  ; m y y
        li   s12, 3 << 28
        sub  s11, s12, s11      ; 3 - m y y
        mul  s9, s9, s11, 14    ; y (3 - m y y) / 2, to 19 bits, 30 fraction bits
        mul  s10, s10, s9, 30   ; g = m y, 31 fraction bits
        wmul w2, s10, s10
        wsub w2, w0, w2         ; m - g g, exact
        wround s11, w2, 14
        mul  s11, s11, s9, 48   ; (m - g g) y / 2
        add  s10, s10, s11      ; g to 31 bits
        lbu  s9, scalings + scaling.half(s8)
        scale s10, s10, s9      ; r, off by 1 at most
        lbu  s9, scalings + scaling.right(s8)
        wsrl w0, w0, s9         ; n = a 2^i
        wmul w2, s10, s10
        wsub w2, w2, w0         ; e = r r - n
        wextend w3, s10, 0
        wadd w5, w2, w3
        wltz w5, w5             ; r is too small when e + r < 0
        wlow s11, w5
        sub  s11, s10, s11
        wsub w5, w2, w3
        wltz w5, w5             ; and too large unless e - r < 0
        wlow s12, w5
        movi s13, -1
        xor  s12, s12, s13
        add  s11, s11, s12
        lw   s12, scalings + scaling.keep(s8)
        and  s11, s11, s12
        lw   s12, scalings + scaling.known(s8)
        or   d, s11, s12
