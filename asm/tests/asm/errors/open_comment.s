        nop
        nop /* what follows is
        not read
