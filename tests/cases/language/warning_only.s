; A warning does not keep a program from running.
        .warning "no shadows"   ; warning W001: no shadows
        halt                    ; count: jump 1
