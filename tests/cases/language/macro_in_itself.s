        .macro again n
        again \n + 1            ; error E021: more than 64 macro calls and repetitions stand inside each other
        .endm
        again 1
