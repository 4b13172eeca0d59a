; machine: buffer_octets = 16
        movi s1, 13
        movi s2, 4
        load s1, s0, s2         ; trap: octets 13..17 of the buffer, which has 16
