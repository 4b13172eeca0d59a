        movi s1, 4
        lwide w1, -3(s1)        ; w1 = 0x0807060504030201
        swide w1, 8(s1)         ; buffer[11] = 0, 1, 2, 3, 4, 5, 6, 7, 8, 0
        wneg w2, w1
        swide w2, 8(s1)         ; buffer[12] = 0xff, 0xfd, 0xfc, 0xfb, 0xfa, 0xf9, 0xf8, 0xf7
        lwide w3, 8(s1)         ; w3 = -0x0807060504030201
        halt                    ; count: sub 1, move 1, jump 1, local 8
        .buffer
        .byte 0, 1, 2, 3, 4, 5, 6, 7, 8, 0, 0, 0
        .wide 0, 0
