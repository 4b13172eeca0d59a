; machine: arithmetic.trap_division_by_zero = true
        movi s1, 7
        wextend w1, s1, 0
        wdiv s1, w1, w2, 0      ; trap: division by zero; s1 = 7
        halt
