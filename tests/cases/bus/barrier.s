; Alone, nobody has to be waited for.
        barrier                 ; count: none
        barrier                 ; clocks: 0
        halt
