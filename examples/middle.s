; Middle of two positions, as a first try: both are halved before they are added.
    .format pos, 16
    .holds s1, pos
    .holds s2, pos
    .holds s3, pos
    call   s31, middle
    halt

    .func  middle           ; s3 = (s1 + s2) / 2
    rshift s1, s1, 1
    rshift s2, s2, 1
    add    s3, s1, s2
    ret    s31
    .endfunc
