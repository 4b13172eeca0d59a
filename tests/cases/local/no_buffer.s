; A core may have no buffer at all.
; machine: buffer_octets = 0
        sb   s0, 0(s0)          ; trap: octets 0..1 of the buffer, which has 0
