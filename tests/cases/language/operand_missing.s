        mul  s1, s2, s3         ; error E005: `mul` takes 4 operands, not 3
        lw   s1                 ; error E005: `lw` is written `lw d, i(a)`
        halt s1                 ; error E005: `halt` takes no operands, not 1
