; A fixed-point number has a sign: one too large is an error, never a negative number.
        .format pos, 16
        li   s1, 32767.99998:pos
        li   s1, 32768:pos      ; error E008: the number does not fit 32 bits with its sign
        li   s1, -32768:pos
        li   s1, 32767:pos + 1:pos ; error E008: the number does not fit 32 bits with its sign
        li   s1, 0x80000000
        .buffer
        .fixed pos, 32767, 32768 ; error E008: 2147483648 does not fit 4 octets
        .word 0x80000000
        .half 0.5:pos           ; error E008: 32768 does not fit 2 octets
