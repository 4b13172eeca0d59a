; The main processor for the load: hands out PIXELS pixels. Each core has the next message in its mailbox while it is at a
; pixel, so that no core waits for the main processor.
.entry feed
.func feed
    .holds v0
    mov   s1, s0                ; pixels handed out
    mov   s4, s0                ; pixels done
    li    s2, PIXELS
    cores s3
.rept 2
    mov   s5, s0
1:  beq   s1, s2, drain
    vput  v0, s1, 0
    send5 s5, v0
    iaddi s1, s1, 1
    iaddi s5, s5, 1
    bne   s5, s3, 1b
.endr
drain:
    recv2 v8, s6
    iaddi s4, s4, 1
    beq   s1, s2, over
    vput  v0, s1, 0
    send5 s6, v0
    iaddi s1, s1, 1
    jump  drain
over:
    bne   s4, s2, drain
    halt
.endfunc
