; The second note has no room in the buffer: all of it is as it was.
; machine: buffer_octets = 48
        .buffer
block:  .word 0x400, 16
        .word 50, 0x408
        .word 25, 0x410
notes:  .word 100, 0, 0
        .word 1, 2, 3
        .text
        movi  s1, 3
        wjoin w2, s1, s0
        vset  v2, 1, 1, 0, s4
        movi  s2, 0x400
        movi  s3, notes
        rwalk w1, s2, s3, v1, w2, s0    ; trap: octets 48..60 of the buffer, which has 48
        halt
