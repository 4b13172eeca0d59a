; machine: buffer_octets = 64
        lwide w1, 56(s0)
        swide w1, 57(s0)        ; trap: octets 57..65 of the buffer, which has 64
