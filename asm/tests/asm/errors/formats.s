        .format pos, 16
        li s1, 0.5
        li s1, 0.5:pso
        .format wide, 64
        .buffer
        .fixed dir, 1
        .fixed pos, 40000, 1.5, 99999999999
