        vdto s4, v1, v2, 16     ; error E001: `vdto` is not an instruction
        halt
