        .endfunc
        .endregion
        .endstruct
        .endif
        .else
        .endm
        .endr
        .exitm
        .local a
        .field a, 4
        .func f
        .region r
        .endfunc
        .if 1
        .else
        .else
        .endif
