start:  beq s1, s2, far
        jump far
        bne s1, s2, .-40000
        .org 50000
far:    halt
