        ADD s1, s2, s3          ; error E001: `ADD` is not an instruction
