; Read and written back in one transfer; the sum is modulo 2^32.
        li   s1, 0x7fffffff
        movi s2, 8
        fetchadd s3, s2, s1     ; s3 = 0; memory[8] = 255, 255, 255, 127; clocks: 17
        fetchadd s4, s2, s1     ; s4 = 0x7fffffff
        fetchadd s2, s2, s1     ; s2 = -2; memory[8] = 253, 255, 255, 127
        halt                    ; count: add 3, mem 3, octet 24, move 3, jump 1; clocks: 51
