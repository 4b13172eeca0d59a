        .rept 1000000000
        nop
        .endr
        .buffer
        .space 1 << 40
        .org 1 << 30
        .space -1
        .align 3
        .byte 1, 2
        .org 1
        .text
        .org 1 << 40
        .align 1 << 30
        .rept -1
        .endr
