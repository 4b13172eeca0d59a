        li   s1, 0xffffffff
        li   s1, 0x100000000    ; error E008: the number does not fit 32 bits
        li   s1, -0x80000001    ; error E008: the number does not fit 32 bits
        vset v1, 0, 1 << 40, 0, s1 ; error E008: the number does not fit 32 bits
