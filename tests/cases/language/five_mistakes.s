; All errors of a file show in one run.
start:  vdto  s4, v1, v2, 16    ; error E001: `vdto` is not an instruction
        movi  s1, 40000         ; error E008: 40000 does not fit operand `i` of `movi`
        add   s32, s1, s2       ; error E007: there is no register `s32`
        beqz  s1, strat         ; error E003: `strat` is not defined
        .wrod 5                 ; error E002: `.wrod` is not a directive
