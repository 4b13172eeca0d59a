; Unit vector of a short vector, three times. v2: the square of the length is rounded to a position, of which few bits are left. v3: the
; square is kept whole. v4: the vector is shifted up first, as the kernels do.
.format pos, 16
.format dir, 30
.entry start
.func start
    .holds v1, pos
    li    s1, 0.03:pos
    vput  v1, s1, x
    li    s1, 0.01:pos
    vput  v1, s1, y
    li    s1, 0.02:pos
    vput  v1, s1, z

    vdot  s2, v1, v1, pos
    .holds s2, pos
    wextend w0, s2, pos
    wsqrt s3, w0, 0
    .holds s3, pos
    vdiv  v2, v1, s3, dir
    .holds v2, dir

    wdot  w0, v1, v1
    wsqrt s4, w0, 0
    .holds s4, pos
    vdiv  v3, v1, s4, dir
    .holds v3, dir

    vnorm v4, s5, v1
    wdot  w0, v4, v4
    wsqrt s6, w0, 0
    vdiv  v4, v4, s6, dir
    .holds v4, dir
    halt
.endfunc
