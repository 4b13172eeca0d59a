; A group of registers ends within its file.
        send2 s1, v30
        send2 s1, v31           ; error E008: `v31` cannot be the first of 2 registers
        recv5 v28, s1           ; error E008: `v28` cannot be the first of 5 registers
        wcross w6, v1, v2       ; error E008: `w6` cannot be the first of 3 registers
