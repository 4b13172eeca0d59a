; Three comparisons with the planes to leave by, three with those to enter by; the first of the former, the last of the latter that are
; ahead, and the order of these two. A plane that is not ahead takes part as the start of the ray: run 0, slope 1, axis 3.
; range: a 10 bits
; range: b 10 bits
        .include "order.inc"
        .buffer
leave:  .space 12
        .text
; 1 when the plane of axis \k at \at is ahead.
        .macro ahead d, k, at
        vget s27, v1, \k
        mov  s28, \at
        vget s29, v2, \k
        srai s29, s29, 31
        exchange s27, s28, s29
        slt  \d, s27, s28
        .endm
        face s8, 0, v3, v4
        face s9, 1, v3, v4
        face s10, 2, v3, v4
        ahead s11, 0, s8
        ahead s12, 1, s9
        ahead s13, 2, s10
        and  s11, s11, s12
        and  s11, s11, s13
        beqz s11, missed
        face s11, 0, v4, v3
        face s12, 1, v4, v3
        face s13, 2, v4, v3
        ahead s20, 0, s11
        ahead s21, 1, s12
        ahead s22, 2, s13
        vget s14, v2, 0
        vget s15, v2, 1
        vget s16, v2, 2
; The plane by which it leaves: s17 its axis, s8 where, s23 its run, s10 its slope.
        sw   s11, leave(s0)
        sw   s12, leave + 4(s0)
        sw   s13, leave + 8(s0)
        run  s23, 0, s8
        run  s12, 1, s9
        run  s13, 2, s10
        movi s17, 0
        movi s18, 1
        order s19, s17, s23, s14, s18, s12, s15
        choose s17, s17, s18, s19
        choose s8, s8, s9, s19
        choose s23, s23, s12, s19
        choose s9, s14, s15, s19
        movi s18, 2
        order s19, s17, s23, s9, s18, s13, s16
        choose s17, s17, s18, s19
        choose s8, s8, s10, s19
        choose s23, s23, s13, s19
        choose s10, s9, s16, s19
        wjoin e, s17, s8
        movi s18, 3
        wjoin d, s18, s0
        or   s9, s20, s21
        or   s9, s9, s22
        beqz s9, finished
; The plane by which it enters: s9 its axis, s11 where, s12 its run, s13 its slope.
        .macro candidate axis, at, run, slope, k, flag
        lw   \at, leave + 4 * \k(s0)
        run  \run, \k, \at
        slli \flag, \flag, 31
        srai \flag, \flag, 31
        and  \run, \run, \flag
        movi s27, 1
        choose \slope, \slope, s27, \flag
        movi s27, \k
        movi s28, 3
        choose \axis, s27, s28, \flag
        .endm
        candidate s9, s11, s12, s14, 0, s20
        mov  s13, s14
        candidate s18, s19, s20, s15, 1, s21
        order s8, s9, s12, s13, s18, s20, s15
        choose s9, s18, s9, s8
        choose s11, s19, s11, s8
        choose s12, s20, s12, s8
        choose s13, s15, s13, s8
        candidate s18, s19, s20, s16, 2, s22
        order s8, s9, s12, s13, s18, s20, s16
        choose s9, s18, s9, s8
        choose s11, s19, s11, s8
        choose s12, s20, s12, s8
        choose s13, s16, s13, s8
        wjoin d, s9, s11
        order s8, s9, s12, s13, s17, s23, s10
        bnez s8, finished
missed: movi s8, -1
        wjoin d, s8, s8
        wjoin e, s8, s8
finished:
