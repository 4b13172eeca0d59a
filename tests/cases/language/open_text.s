; error E012 line 4: the text has no closing quotation mark
        halt
        .buffer
        .asciz "open
