; memory: 16
        movi s1, 16
        load s0, s0, s1         ; buffer[0] = 0, 0, 0
        load s1, s1, s0         ; clocks: 32 -- nothing from just behind the end
        movi s2, 1
        load s0, s1, s2         ; trap: octets 16..17 of global memory, which has 16
