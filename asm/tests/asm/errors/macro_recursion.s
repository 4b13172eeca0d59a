        .macro again n
        again \n + 1
        .endm
        again 1
