; A loop without end meets the limit of instructions.
; machine: step_limit = 50
here:   jump here               ; trap: more than 50 instructions in a work item; count: jump 50
