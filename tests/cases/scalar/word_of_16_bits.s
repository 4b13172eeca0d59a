; Words of 16 bits: every numeric result is brought into them, constants and integer rows are not.
; machine: arithmetic.word = 16
        li   s1, 32767
        li   s2, -32768
        movi s3, 1
        li   s4, 100000         ; s4 = 100000
        add  s5, s1, s3         ; s5 = 32767
        sub  s6, s2, s3         ; s6 = -32768
        neg  s7, s2             ; s7 = 32767
        abs  s8, s2             ; s8 = 32767
        mul  s9, s1, s1, 15     ; s9 = 32766 -- 2^15 - 2 + 2^-15
        mul  s10, s2, s2, 15    ; s10 = 32767
        div  s11, s2, s0, 0     ; s11 = -32768
        min  s12, s4, s4        ; s12 = 32767
        max  s13, s4, s0        ; s13 = 32767
        rshift s14, s4, 1       ; s14 = 32767 -- 50000
        lshift s15, s1, 1       ; s15 = 32767
        iadd s16, s4, s4        ; s16 = 200000
        halt
