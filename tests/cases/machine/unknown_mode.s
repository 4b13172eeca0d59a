; machine: arithmetic.overflow = "SATURATE"
; error: unknown mode `SATURATE`, expected one of `SAT`, `SAT_ZERO`, `SAT_SYM`, `WRAP`, `WRAP_SM`
        halt
