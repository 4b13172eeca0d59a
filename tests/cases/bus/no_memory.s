; memory: 0
        stw  s0, 0(s0)          ; trap: octets 0..4 of global memory, which has 0
