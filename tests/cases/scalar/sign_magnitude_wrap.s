; WRAP_SM: the low bits, inverted where the lowest deleted bit differs from the sign that is left.
; machine: arithmetic.overflow = "WRAP_SM"
        li   s1, 0x7fffffff
        movi s2, 1
        add  s3, s1, s2         ; s3 = 0x7fffffff -- 2^31 is 0 1000...: the deleted 0 differs from the sign 1
        lshift s4, s2, 32       ; s4 = -1 -- 2^32 is 1 0000...: the deleted 1 differs from the sign 0
        li   s5, -0x80000000
        sub  s6, s5, s2         ; s6 = -0x80000000 -- -2^31 - 1 is 1 0111...
        halt
