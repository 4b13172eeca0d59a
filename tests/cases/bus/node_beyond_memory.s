; memory: 16
        movi  s2, 64
        ldnode w0, s2, 10, 6            ; trap: octets 16..18 of global memory, which has 16
