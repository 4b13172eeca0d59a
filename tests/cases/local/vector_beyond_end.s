; machine: buffer_octets = 64
        lv   v1, 52(s0)
        movi s1, 53
        sv   v1, 0(s1)          ; trap: octets 53..65 of the buffer, which has 64
