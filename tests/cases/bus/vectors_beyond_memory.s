; Nine words do not fit where eight do.
        ldwide w1, 56(s0)
        ldv3  v2, 28(s0)
        ldv3  v2, 32(s0)                ; trap: octets 32..68 of global memory, which has 64
        halt
