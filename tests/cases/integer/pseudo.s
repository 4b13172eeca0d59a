; Pseudo-instructions of constants and copies.
        nop                     ; count: move 1
        li   s1, 7              ; s1 = 7; count: move 2
        li   s2, 70000          ; s2 = 70000; count: move 4
        la   s3, table          ; s3 = 4
        szero s1                ; s1 = 0
        vset v1, 5, 5, 5, s4    ; v1 = 5, 5, 5; s4 = 5
        vset v2, 1, -70000, 3, s4 ; v2 = 1, -70000, 3; s4 = 3
        vzero v1                ; v1 = 0, 0, 0
        halt
        .buffer
        .word 1
table:  .word 2
