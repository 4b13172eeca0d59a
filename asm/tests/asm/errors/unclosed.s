        .func trace
        .region inner
        .struct node
        .field a, 1
        .if 1
        nop
