; The last word that begins within the buffer, but does not end there.
; machine: buffer_octets = 64
        lw   s1, 60(s0)         ; s1 = 0xa5a5a5a5
        lw   s1, 61(s0)         ; trap: octets 61..65 of the buffer, which has 64; s1 = 0xa5a5a5a5
        halt
