; Numbers of few bits, which stand bit behind bit, become words of the buffer.
        li    s1, 0x00fab123
        stw   s1, 8(s0)
        movi  s2, 8
        movi  s3, 2
        movi  s4, 100
        loadf s4, s2, s3, 12
        lw    s5, 100(s0)               ; s5 = 291
        lw    s6, 104(s0)               ; s6 = -85
        loadfu s4, s2, s3, 12
        lw    s5, 100(s0)               ; s5 = 291
        lw    s6, 104(s0)               ; s6 = 4011
        movi  s3, 1
        loadfu s4, s2, s3, 32
        lw    s5, 100(s0)               ; s5 = 16429347
        loadf s4, s2, s3, 0
        lw    s5, 100(s0)               ; s5 = 0
        halt
