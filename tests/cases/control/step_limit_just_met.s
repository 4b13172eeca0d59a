; As many instructions as are allowed.
; machine: step_limit = 3
        nop
        nop
        halt                    ; count: move 2, jump 1
