; machine: buffer_octets = 16
; error: the program's data take 17 octets, but the buffer of a core has 16
        halt
        .buffer
        .space 17
