; Nothing is stored by halves.
; machine: buffer_octets = 64
        sw   s0, 60(s0)         ; buffer[60] = 0, 0, 0, 0
        movi s1, -1
        sw   s1, 62(s0)         ; trap: octets 62..66 of the buffer, which has 64; buffer[60] = 0, 0, 0, 0
