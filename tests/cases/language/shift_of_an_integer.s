; Five bits hold 0 to 31.
        slli s1, s2, 31
        slli s1, s2, 32         ; error E008: 32 does not fit operand `i` of `slli`
        srai s1, s2, -1         ; error E008: -1 does not fit operand `i` of `srai`
