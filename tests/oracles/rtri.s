; The formulas of Moeller and Trumbore, with tests before divisions. An edge function of 0 is decided by the sign of the first component other
; than 0 of the edge's normal, found by logic; a normal of 0 counts as negative.
; range: a 14 bits
; range: b 14 bits
; arithmetic: default
        .buffer
u:      .space 8
v:      .space 8
        .text
; Edges s8 to s10 and s11 to s13, start s14 to s16, direction s19 to s21, the determinant w3, its sign that of s22.
        .macro difference d, to, from, k
        vget s17, \to, \k
        vget s18, \from, \k
        sub  \d, s17, s18
        .endm
        .macro differences x, y, z, to, from
        difference \x, \to, \from, 0
        difference \y, \to, \from, 1
        difference \z, \to, \from, 2
        .endm
        .macro minor d, p, q, r, s
        wmul \d, \p, \q
        wmul w7, \r, \s
        wsub \d, \d, w7
        .endm
; w0 to w2 = the cross product.
        .macro cross ax, ay, az, bx, by, bz
        minor w0, \ay, \bz, \az, \by
        minor w1, \az, \bx, \ax, \bz
        minor w2, \ax, \by, \ay, \bx
        .endm
; \d = the dot product of w0 to w2 with a vector.
        .macro dot d, x, y, z
        wextend w6, \x, 0
        wmulw \d, w0, w6
        wextend w6, \y, 0
        wmulw w6, w1, w6
        wadd \d, \d, w6
        wextend w6, \z, 0
        wmulw w6, w2, w6
        wadd \d, \d, w6
        .endm
; The sign of a component, as long as all before it were 0: s23 collects the sign, s30 stays all ones as long as there was none.
        .macro sign_of p, q, r, s
        minor w5, \p, \q, \r, \s
        whigh s17, w5
        and  s18, s17, s30
        or   s23, s23, s18
        wlow s18, w5
        or   s17, s17, s18
        clz  s17, s17
        srli s17, s17, 5
        slli s17, s17, 31
        srai s17, s17, 31
        and  s30, s30, s17
        .endm
; Leaves for missed unless the edge function has the determinant's sign.
        .macro inside edge, from, to
        bwnez \edge, sure_\@
        differences s24, s25, s26, \from, v1
        differences s27, s28, s29, \to, v1
        mov  s23, s0
        movi s30, -1
        sign_of s25, s29, s26, s28
        sign_of s26, s27, s24, s29
        sign_of s24, s28, s25, s27
        xor  s23, s23, s22
        or   s23, s23, s30
        jump decided_\@
sure_\@:
        whigh s23, \edge
        xor  s23, s23, s22
decided_\@:
        bltz s23, missed
        .endm
        differences s8, s9, s10, v4, v3
        differences s11, s12, s13, v5, v3
        vget s19, v2, 0
        vget s20, v2, 1
        vget s21, v2, 2
        cross s19, s20, s21, s11, s12, s13
        dot  w3, s8, s9, s10
        bweqz w3, missed
        whigh s22, w3
        differences s14, s15, s16, v1, v3
        dot  w4, s14, s15, s16
        swide w4, u(s0)
        inside w4, v3, v5
        cross s14, s15, s16, s8, s9, s10
        dot  w4, s19, s20, s21
        swide w4, v(s0)
        inside w4, v4, v3
        lwide w5, u(s0)
        wsub w5, w3, w5
        wsub w4, w5, w4
        inside w4, v5, v4
        dot  w4, s11, s12, s13
        bweqz w4, missed
        whigh s23, w4
        xor  s23, s23, s22
        bltz s23, missed
        wdiv d, w4, w3, i
        lwide w4, u(s0)
        wdiv s8, w4, w3, 30
        lwide w4, v(s0)
        wdiv s9, w4, w3, 30
        vsplat e, s0
        vput e, s8, 0
        vput e, s9, 1
        jump finished
missed: li   d, 0x7fffffff
        vsplat e, s0
finished:
