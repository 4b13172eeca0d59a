; machine: arithmetic.word = 7
; error: `arithmetic.word` is 7, but must lie in 8..=32
        halt
