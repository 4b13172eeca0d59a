        .macro never a
        nop
