; One component over zero is enough.
; machine: arithmetic.trap_division_by_zero = true
        vset v1, 7, 0, 0, s1
        vdiv v2, v1, s0, 0      ; trap: division by zero; v2 = 0, 0, 0
        halt
