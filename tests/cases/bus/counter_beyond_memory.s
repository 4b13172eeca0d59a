; memory: 16
        movi s1, -4
        fetchadd s2, s1, s0     ; trap: octets 4294967292..4294967296 of global memory, which has 16
