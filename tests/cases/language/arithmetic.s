; Expressions have 64 bits and say so.
        .equ a, 1 << 63         ; error E014: the result does not fit 64 bits
        .equ b, 5 / (3 - 3)     ; error E015: division by zero
        .equ c, 1 << 64         ; error E037: shifts go from 0 to 63
