; Three runs, and the first of three planes by two orders.
; range: a 10 bits
; range: b 10 bits
        .include "order.inc"
        face s8, 0, v3, v4
        face s9, 1, v3, v4
        face s10, 2, v3, v4
        run  s11, 0, s8
        run  s12, 1, s9
        run  s13, 2, s10
        vget s14, v2, 0
        vget s15, v2, 1
        vget s16, v2, 2
        movi s17, 0
        movi s18, 1
        order s19, s17, s11, s14, s18, s12, s15
        choose s17, s17, s18, s19
        choose s8, s8, s9, s19
        choose s11, s11, s12, s19
        choose s14, s14, s15, s19
        movi s18, 2
        order s19, s17, s11, s14, s18, s13, s16
        choose s17, s17, s18, s19
        choose s8, s8, s10, s19
        wjoin d, s17, s8
