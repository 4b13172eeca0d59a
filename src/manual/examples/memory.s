;; lbu
        movi    s1, table
        lbu     s2, 3(s1)               ; s2 = 18
        halt
        .buffer
table:  .word   0x12345678, -2, 3

;; lh
        movi    s1, table
        lh      s2, 4(s1)               ; s2 = -2
        halt
        .buffer
table:  .word   0x12345678, -2, 3

;; lhu
        movi    s1, table
        lhu     s2, 4(s1)               ; s2 = 65534
        halt
        .buffer
table:  .word   0x12345678, -2, 3

;; lw
        movi    s1, table
        lw      s2, 4(s1)               ; s2 = -2
        halt
        .buffer
table:  .word   0x12345678, -2, 3

;; sb
        movi    s1, table
        movi    s2, 7
        sb      s2, 1(s1)               ; buffer[0] = 0x78, 7, 0x34, 0x12
        halt
        .buffer
table:  .word   0x12345678, -2, 3

;; sh
        movi    s1, table
        movi    s2, 7
        sh      s2, 0(s1)               ; buffer[0] = 7, 0, 0x34, 0x12
        halt
        .buffer
table:  .word   0x12345678, -2, 3

;; sw
        movi    s1, table
        movi    s2, 7
        sw      s2, 0(s1)               ; buffer[0] = 7, 0, 0, 0
        halt
        .buffer
table:  .word   0x12345678, -2, 3

;; lv
        movi    s1, table
        lv      v1, 0(s1)               ; v1 = 305419896, -2, 3
        halt
        .buffer
table:  .word   0x12345678, -2, 3

;; sv
        movi    s1, table
        vset    v1, 1, 2, 3, s2
        sv      v1, 0(s1)               ; buffer[0] = 1, 0, 0, 0, 2, 0, 0, 0, 3, 0, 0, 0
        halt
        .buffer
table:  .word   0x12345678, -2, 3

;; lvh
        movi    s1, table
        lvh     v1, 0(s1), 16           ; v1 = 65536, -131072, 196608
        halt
        .buffer
table:  .half   1, -2, 3

;; lwide
        movi    s1, table
        lwide   w0, 0(s1)               ; w0 = -8284514696
        halt
        .buffer
table:  .word   0x12345678, -2, 3

;; swide
        movi    s1, table
        movi    s2, 7
        wextend w0, s2, 0
        swide   w0, 0(s1)               ; buffer[0] = 7, 0, 0, 0, 0, 0, 0, 0
        halt
        .buffer
table:  .word   0x12345678, -2, 3

;; lwp
        movi    s1, table
        lwp     s2, 4(s1)               ; s2 = 305419896; s1 = 4
        halt
        .buffer
table:  .word   0x12345678, -2, 3

;; lvp
        movi    s1, table
        lvp     v1, 12(s1)              ; v1 = 305419896, -2, 3; s1 = 12
        halt
        .buffer
table:  .word   0x12345678, -2, 3

;; swp
        movi    s1, table
        movi    s2, 7
        swp     s2, 4(s1)               ; buffer[0] = 7, 0, 0, 0; s1 = 4
        halt
        .buffer
table:  .word   0x12345678, -2, 3

;; load
        movi    s1, table
        movi    s2, 8
        movi    s3, 4
        load    s1, s2, s3              ; buffer[0] = 0, 0, 0, 0
        halt
        .buffer
table:  .word   -1

;; store
        movi    s1, 8
        movi    s2, table
        movi    s3, 4
        store   s1, s2, s3              ; memory[8] = 1, 2, 3, 4
        halt
        .buffer
table:  .byte   1, 2, 3, 4

;; ldw
        movi    s1, 7
        movi    s2, 8
        stw     s1, 0(s2)
        ldw     s3, 0(s2)               ; s3 = 7
        halt

;; ldwide
        movi    s1, 7
        movi    s2, 8
        stw     s1, 4(s2)
        ldwide  w0, 0(s2)               ; w0 = 30064771072
        halt

;; ldv3
        vset    v1, 1, 2, 3, s1
        movi    s2, 0
        stv     v1, 12(s2)
        ldv3    v4, 0(s2)               ; v4 = 0, 0, 0; v5 = 1, 2, 3; v6 = 0, 0, 0
        halt

;; loadf
        li      s1, 0x00fab123
        stw     s1, 0(s0)
        movi    s2, 2
        movi    s3, 100
        loadf   s3, s0, s2, 12          ; buffer[100] = 35, 1, 0, 0, 171, 255, 255, 255
        halt

;; loadfu
        li      s1, 0x00fab123
        stw     s1, 0(s0)
        movi    s2, 2
        movi    s3, 100
        loadfu  s3, s0, s2, 12          ; buffer[100] = 35, 1, 0, 0, 171, 15, 0, 0
        halt

;; ldv3f
        li      s1, 0x08f7
        stw     s1, 0(s0)
        ldv3f   v1, 0(s0), 4            ; v1 = 7, -1, -8; v2 = 0, 0, 0; v3 = 0, 0, 0
        halt

;; ldnode
        movi    s1, 0x7a
        stw     s1, 16(s0)
        movi    s2, 128
        ldnode  w0, s2, 3, 4            ; w0 = 115964116994
        halt

;; loadnode
        movi    s1, 0x7a
        stw     s1, 16(s0)
        movi    s2, 128
        movi    s3, 1
        movi    s4, 100
        loadnode s4, s2, s3, 3, 4       ; buffer[100] = 2, 0, 0, 0, 27, 0, 0, 0
        halt

;; stw
        movi    s1, 7
        movi    s2, 8
        stw     s1, 4(s2)               ; memory[12] = 7, 0, 0, 0
        halt

;; stv
        vset    v1, 1, 2, 3, s1
        movi    s2, 8
        stv     v1, 0(s2)               ; memory[8] = 1, 0, 0, 0, 2, 0, 0, 0, 3, 0, 0, 0
        halt

;; fetchadd
        movi    s1, 8
        movi    s2, 5
        fetchadd s3, s1, s2             ; s3 = 0; memory[8] = 5, 0, 0, 0
        halt

;; send2
        vset    v1, 1, 2, 3, s1
        vset    v2, 4, 5, 6, s1
        core    s2
        send2   s2, v1                          ; exit Done
        recv2   v3, s3                  ; v3 = 1, 2, 3; v4 = 4, 5, 6
        halt

;; send5
        vset    v1, 1, 2, 3, s1
        vset    v2, 4, 5, 6, s1
        core    s2
        send5   s2, v1                          ; exit Done
        recv5   v8, s3                  ; v8 = 1, 2, 3; v9 = 4, 5, 6
        halt

;; recv2
        vset    v1, 1, 2, 3, s1
        vset    v2, 4, 5, 6, s1
        core    s2
        send2   s2, v1
        recv2   v3, s3                  ; v3 = 1, 2, 3; v4 = 4, 5, 6; s3 = 0
        halt

;; recv5
        vset    v1, 1, 2, 3, s1
        vset    v2, 4, 5, 6, s1
        core    s2
        send5   s2, v1
        recv5   v8, s3                  ; v8 = 1, 2, 3; v9 = 4, 5, 6; s3 = 0
        halt

;; barrier
        barrier                         ; exit Done -- a core alone does not wait
        halt
