        lw   s1, 32767(s2)
        lw   s1, 32768(s2)      ; error E008: 32768 does not fit operand `i` of `lw`
        stw  s1, -32769(s2)     ; error E008: -32769 does not fit operand `i` of `stw`
        lvh  v1, 512(s2), 0     ; error E008: 512 does not fit operand `i` of `lvh`
        lwp  s1, 32768(s2)      ; error E008: 32768 does not fit operand `i` of `lwp`
