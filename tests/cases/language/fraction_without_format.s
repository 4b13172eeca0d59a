        .format pos, 16
        li   s1, 0.5            ; error E018: a number with a fraction needs a format
        li   s1, 0.5:pso        ; error E019: `pso` is not defined
        li   s1, 65536:pos      ; error E008: the number does not fit 32 bits with its sign
