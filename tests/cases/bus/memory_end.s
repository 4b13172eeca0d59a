; memory: 16
        ldw  s1, 12(s0)         ; s1 = 0
        ldw  s1, 13(s0)         ; trap: octets 13..17 of global memory, which has 16
