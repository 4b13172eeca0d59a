; Six bits hold 0 to 63.
        mul  s1, s2, s3, 63
        mul  s1, s2, s3, 64     ; error E008: 64 does not fit operand `i` of `mul`
        vdot s1, v2, v3, -1     ; error E008: -1 does not fit operand `i` of `vdot`
        wsqrt s1, w1, 64        ; error E008: 64 does not fit operand `i` of `wsqrt`
        lvh  v1, 0(s1), 64      ; error E008: 64 does not fit operand `j` of `lvh`
