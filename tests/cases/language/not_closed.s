        .func trace             ; error E022: `.endfunc` is missing
        halt
