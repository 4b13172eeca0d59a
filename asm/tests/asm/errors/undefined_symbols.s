        .equ distance, 4
        movi s1, distanse
        j nowhere
        .buffer
        .word distance * tabel
