        mov  s32, s1            ; error E007: there is no register `s32`
        vmov v1, v32            ; error E007: there is no register `v32`
        wmov w8, w1             ; error E007: there is no register `w8`
        mov  s01, s1            ; error E007: there is no register `s01`
