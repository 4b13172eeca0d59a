; Addresses are unsigned: one below 0 is far beyond the end.
        movi s1, 4
        lbu  s2, -4(s1)
        lbu  s2, -5(s1)         ; trap: octets 4294967295..4294967296 of the buffer, which has 18525
