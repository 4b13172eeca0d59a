size = 4
        .equ size, 5
again:  nop
again:  halt
        .equ once, 1
        .equ once, 2
        .struct node
        .field a, 1
        .field a, 1
        .endstruct
        .struct node
        .endstruct
        .format f, 3
        .format f, 4
