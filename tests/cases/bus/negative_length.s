; A length below 0 is a length near 2^32.
        movi s1, -1
        store s0, s0, s1        ; trap: octets 0..4294967295 of the buffer, which has 18525
