        .macro copy to, from:req
        mov \to, \from
        .endm
        copy s1
        copy s1, s2, s3
        copy s1, to=s2
        copy s1, form=s2
        .macro add a
        .endm
        .macro twice a, a
        .endm
        .macro copy a
        .endm
        .macro  odd a:rec
        .endm
