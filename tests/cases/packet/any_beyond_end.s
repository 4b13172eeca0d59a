; A negative number of triangles is more than any buffer has.
        movi  s3, -1
        rany  v3, v1, s0, s3, 0         ; trap: octets 0..4294967295 of the buffer, which has 18525
        halt
