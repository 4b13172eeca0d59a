; Words of 16 bits, truncated.
; machine: arithmetic.word = 16
; machine: arithmetic.quantization = "TRN"
        vset v1, 32767, -32768, 100, s1
        vadd v2, v1, v1         ; v2 = 32767, -32768, 200
        vmul v3, v1, v1, 15     ; v3 = 32766, 32767, 0 -- 32766.00003, 32768, 0.3
        vdot s2, v1, v1, 16     ; s2 = 32767
        vdot s3, v1, v1, 17     ; s3 = 16383 -- 2147426... over 2^17
        vnorm v4, s4, v1        ; v4 = 8191, -8192, 25; s4 = 2
        vset v5, 1, 0, 0, s1
        vnorm v6, s5, v5        ; v6 = 8192, 0, 0; s5 = -13
        halt
