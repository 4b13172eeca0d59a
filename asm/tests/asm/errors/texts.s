        .buffer
        .ascii "open
        .ascii "bad \q escape"
        .byte 'ab'
        .byte '\q'
        .ascii 5
        .byte ''
