; machine: buffer_octets = 64
        lvh  v1, 58(s0), 0
        lvh  v1, 59(s0), 0      ; trap: octets 59..65 of the buffer, which has 64
