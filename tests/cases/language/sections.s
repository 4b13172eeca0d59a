; Data stand in the buffer, code in the code.
        .byte 1                 ; error E027: only words of 32 bits stand in the code
        .buffer
        halt                    ; error E027: the instruction `halt` stands in the buffer
