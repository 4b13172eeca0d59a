        .macro shrink to, by
        mul \to, \to, \by, 64
        vadd \to, \to, \to
        .endm
        .macro both a
        shrink \a, s9
        .endm
        nop
        both s5
        shrink s6, s7
