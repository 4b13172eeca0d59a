        movi s1, 012            ; error E011: `012` is not a number
        movi s1, 0b12           ; error E011: `0b12` is not a number
