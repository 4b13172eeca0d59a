; 0 / 0 is a division by zero as well.
; machine: arithmetic.trap_division_by_zero = true
        div  s3, s0, s0, 0      ; trap: division by zero
        halt
