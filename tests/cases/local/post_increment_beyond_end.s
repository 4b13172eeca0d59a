; The register keeps its address, for whoever looks.
; machine: buffer_octets = 64
        movi s1, 64
        swp  s0, 4(s1)          ; trap: octets 64..68 of the buffer, which has 64; s1 = 64
