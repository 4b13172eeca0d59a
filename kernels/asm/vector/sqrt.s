; Square root of a wide number, correctly rounded. In: w0 >= 0. Out: s12. Returns by link_leaf.
.func sqrt
    .holds s12
    wsqrt s12, w0, 0
    ret   link_leaf
.endfunc
