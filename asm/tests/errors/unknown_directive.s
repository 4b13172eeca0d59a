        .globl start
        .bufer
