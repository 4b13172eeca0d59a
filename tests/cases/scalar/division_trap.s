; A machine may trap where something is divided by zero. What the instruction would have written is not written.
; machine: arithmetic.trap_division_by_zero = true
        movi s1, 5
        movi s2, 3
        div  s3, s1, s2, 0      ; s3 = 2
        div  s3, s1, s0, 0      ; trap: division by zero; s3 = 2; count: div 1, move 2
        halt
