; Clocks of an instruction are those of its classes, one after the other; the bus has its own.
; machine: clocks.mul = 3
; machine: clocks.local = 1
; machine: units.mul = 2
; machine: bus.octets_per_beat = 4
; machine: bus.clocks_per_beat = 1
; machine: bus.setup_clocks = 5
        mul  s1, s1, s1, 0      ; clocks: 3
        vmul v1, v1, v1, 0      ; clocks: 9 -- three products on two units
        vcross v1, v1, v1, 0    ; clocks: 21 -- 3 differences and 6 products
        lv   v1, 0(s0)          ; clocks: 24
        movi s2, 9
        store s0, s0, s2        ; clocks: 32 -- 5 and three beats
        halt                    ; clocks: 32
