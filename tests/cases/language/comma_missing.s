        add  s1 s2, s3          ; error E010: expected a comma or the end of the line, found `s2`
        add  s1, s2,            ; error E010: expected a number
