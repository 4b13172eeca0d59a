; Absolute values of 32 unsigned bits, and two comparisons.
        .macro magnitude to, component
        vget \to, a, \component
        srai s8, \to, 31
        xor  \to, \to, s8
        isub \to, \to, s8
        .endm
        magnitude s9, 0
        magnitude s10, 1
        magnitude s11, 2
        movi d, 0
        bgeu s9, s10, 1f
        mov  s9, s10
        movi d, 1
1:      bgeu s9, s11, 2f
        movi d, 2
2:
