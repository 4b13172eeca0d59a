; A store that does not fit stores nothing.
; memory: 16
        vset v1, -1, -1, -1, s1
        stv  v1, 4(s0)          ; memory[4] = 255, 255, 255
        stv  v1, 5(s0)          ; trap: octets 5..17 of global memory, which has 16; memory[0] = 0, 0, 0, 0, 255
