; TRN_ZERO: towards zero.
; machine: arithmetic.quantization = "TRN_ZERO"
        movi s1, 4
        movi s2, 1
        rshift s3, s2, 2        ; s3 = 0 -- 0.25
        div  s4, s2, s1, 0      ; s4 = 0
        movi s2, 2
        rshift s3, s2, 2        ; s3 = 0 -- 0.5
        div  s4, s2, s1, 0      ; s4 = 0
        movi s2, 3
        rshift s3, s2, 2        ; s3 = 0 -- 0.75
        div  s4, s2, s1, 0      ; s4 = 0
        movi s2, 5
        rshift s3, s2, 2        ; s3 = 1 -- 1.25
        div  s4, s2, s1, 0      ; s4 = 1
        movi s2, 6
        rshift s3, s2, 2        ; s3 = 1 -- 1.5
        div  s4, s2, s1, 0      ; s4 = 1
        movi s2, 10
        rshift s3, s2, 2        ; s3 = 2 -- 2.5
        div  s4, s2, s1, 0      ; s4 = 2
        movi s2, -1
        rshift s3, s2, 2        ; s3 = 0 -- -0.25
        div  s4, s2, s1, 0      ; s4 = 0
        movi s2, -2
        rshift s3, s2, 2        ; s3 = 0 -- -0.5
        div  s4, s2, s1, 0      ; s4 = 0
        movi s2, -3
        rshift s3, s2, 2        ; s3 = 0 -- -0.75
        div  s4, s2, s1, 0      ; s4 = 0
        movi s2, -5
        rshift s3, s2, 2        ; s3 = -1 -- -1.25
        div  s4, s2, s1, 0      ; s4 = -1
        movi s2, -6
        rshift s3, s2, 2        ; s3 = -1 -- -1.5
        div  s4, s2, s1, 0      ; s4 = -1
        movi s2, -10
        rshift s3, s2, 2        ; s3 = -2 -- -2.5
        div  s4, s2, s1, 0      ; s4 = -2
        halt                    ; count: div 12, move 13, logic 12, jump 1
