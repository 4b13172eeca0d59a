; machine: buffer_octets = 16
        lw   s1, 12(s0)         ; s1 = 0
        halt
        .buffer
        .space 16
