; Blocks go both ways; a request is one whatever its length, and the bus takes two clocks an octet.
        movi s1, 5
        movi s2, 3
        store s1, s2, s2        ; memory[4] = 0, 3, 4, 5, 0; clocks: 6; count: mem 1, octet 3, move 2
        movi s3, 4
        load s0, s3, s3         ; buffer[0] = 0, 3, 4, 5, 4, 5; clocks: 14
        load s3, s0, s0         ; clocks: 14 -- no octets at all
        halt                    ; count: mem 3, octet 7, move 3, jump 1
        .buffer
        .byte 0, 1, 2, 3, 4, 5, 6, 7
