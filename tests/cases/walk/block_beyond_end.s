; A block that leaves the buffer.
        .buffer
block:  .word 0x400, 0x7fffffff
        .text
        rwalk w1, s2, s3, v1, w2, s0    ; trap: octets 8..2147483655 of the buffer, which has 18525
        halt
