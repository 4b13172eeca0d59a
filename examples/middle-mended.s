; Middle of two positions: the sum is halved, so that one result is rounded instead of two.
    .format pos, 16
    .holds s1, pos
    .holds s2, pos
    .holds s3, pos
    call   s31, middle
    halt

    .func  middle           ; s3 = (s1 + s2) / 2
    add    s3, s1, s2
    rshift s3, s3, 1
    ret    s31
    .endfunc
