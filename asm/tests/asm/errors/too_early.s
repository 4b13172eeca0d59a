        .if end > 100
        nop
        .endif
        .rept end
        nop
        .endr
        .buffer
        .space undefined_anywhere
        .align end
        .text
end:    halt
