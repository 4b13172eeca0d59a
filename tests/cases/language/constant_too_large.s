; A constant never loses bits.
        movi s1, 32767
        movi s1, 32768          ; error E008: 32768 does not fit operand `i` of `movi`
        movi s1, -32769         ; error E008: -32769 does not fit operand `i` of `movi`
        andi s1, s1, 65535
        andi s1, s1, 65536      ; error E008: 65536 does not fit operand `i` of `andi`
        ori  s1, s1, -1         ; error E008: -1 does not fit operand `i` of `ori`
        iaddi s1, s1, 40000     ; error E008: 40000 does not fit operand `i` of `iaddi`
        element s1, s1, s1, 2048 ; error E008: 2048 does not fit operand `i` of `element`
        trap 1 << 26            ; error E008: 67108864 does not fit operand `i` of `trap`
