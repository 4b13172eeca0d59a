; A ray is two vectors, a triangle three.
        rtri  s2, v6, v31, v3, 0        ; error E008: `v31` cannot be the first of 2 registers
        rtri  s2, v6, v1, v30, 0        ; error E008: `v30` cannot be the first of 3 registers
        rstep s5, s6, v1, w6, 8         ; error E008: `w6` cannot be the first of 3 registers
        rstep s5, s6, v1, w5, 32        ; error E008: 32 does not fit operand `i` of `rstep`
        halt
