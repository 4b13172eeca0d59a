; A limit is an error, never a long wait.
        .rept 1000000000        ; error E025: 1000000000 repetitions of 1 lines make more than 1000000 lines
        nop
        .endr
