        vget s1, v2, z
        vget s1, v2, 3          ; error E008: 3 does not fit operand `i` of `vget`
        vput v1, s2, -1         ; error E008: -1 does not fit operand `i` of `vput`
