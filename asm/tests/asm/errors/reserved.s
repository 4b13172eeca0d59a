s1:     nop
        .equ min, 5
        .reg count, s5
count:  nop
        .equ limit, 5
        .reg limit, s6
        .set v40, 5
        .reg count, s6
        .unreg total
