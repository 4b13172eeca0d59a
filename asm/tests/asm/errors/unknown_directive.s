        .section start
        .bufer
        .ifx    1
        .else
        .endif
        .repeat 3
        .endr
        .if     0
        .ifx    1
        .endif
        .endif
