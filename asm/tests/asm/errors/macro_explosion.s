        .macro twice depth
        .if \depth
        twice \depth - 1
        twice \depth - 1
        .endif
        .endm
        twice 40
