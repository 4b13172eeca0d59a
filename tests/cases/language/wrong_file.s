; A register of another file, in every place.
        vadd s1, v2, v3         ; error E006: operand `d` of `vadd` is a vector register, not a scalar register
        vdot v1, v2, v3, 0      ; error E006: operand `d` of `vdot` is a scalar register, not a vector register
        wmul w1, w2, s3         ; error E006: operand `a` of `wmul` is a scalar register, not a wide accumulator
        wcross v1, v2, v3       ; error E006: operand `d` of `wcross` is the first of several wide accumulators, not a vector register
        lw   s1, 8(v2)          ; error E006: operand `a` of `lw` is a scalar register with an address, not a vector register
        add  s1, s2, 4          ; error E006: operand `b` of `add` is a scalar register, not a number
        movi s1, s2             ; error E006: operand `i` of `movi` is a signed number, not a scalar register
