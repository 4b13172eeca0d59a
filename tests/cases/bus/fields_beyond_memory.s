; memory: 16
; Three numbers of 20 bits are 8 octets.
        movi  s2, 8
        movi  s3, 3
        loadf s0, s2, s3, 20
        movi  s2, 9
        loadfu s0, s2, s3, 20           ; trap: octets 9..17 of global memory, which has 16
