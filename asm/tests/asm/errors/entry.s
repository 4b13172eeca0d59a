        nop
        .entry 7
        .entry nop_here
