; Four lanes test as many triangles in the time of one.
; machine: packet_lanes = 4
        .buffer
packet: .space 200
        .text
        movi  s2, packet
        movi  s3, 1
        vset  v3, 9, 0, 0, s1
        rnear v3, v1, s2, s3, 0         ; clocks: 64
        movi  s3, 4
        rnear v3, v1, s2, s3, 0         ; clocks: 128
        movi  s3, 5
        rnear v3, v1, s2, s3, 0         ; clocks: 255
        rany  v3, v1, s2, s3, 0         ; clocks: 380
        halt                            ; count: add 150, sub 270, mul 450, div 15, cmp 59, move 10, jump 1, local 150
