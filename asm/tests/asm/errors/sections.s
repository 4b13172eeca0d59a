        .buffer
value:  .word 5
        add s1, s2, s3
        .func f
        .endfunc
        .text
        .byte 5
        .ascii "text"
        .space 4
        j value
        .entry value
        .struct s
label:  .field a, 4
        nop
        .word 5
        .endstruct
