; A packet that leaves the buffer.
        movi  s2, 18500
        movi  s3, 1
        rnear v3, v1, s2, s3, 0         ; trap: octets 18500..18540 of the buffer, which has 18525
        halt
