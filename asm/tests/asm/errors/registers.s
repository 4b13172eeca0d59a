        mov s32, s1
        vadd v1, v99, v2
        wneg w8, w1
        .reg a, q5
        send2 s1, v31
        lw s1, 4(s40)
