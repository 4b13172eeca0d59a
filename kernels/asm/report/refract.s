; The refracted ray, T = eta (D + c N) - sqrt(k) N with eta = ni / nt, c = N . I and k = 1 - eta^2 (1 - c^2): the third line of 4.2 with
; the cosine sqrt(k) of the refracted ray, where the incident one's is printed. k < 0 is total reflection: there is no ray.
; In: the ray, its hit (near_t, near_slot) and inside. Out: s12 = k or, when k >= 0, something positive; then origin and direction.
; Returns by link_node. Scratch: what surface needs, v9.
.func refract
    call  link_trace, surface
    lw    s12, MATERIAL_AT(s0)
    lw    s13, material.index(s12)
    .holds s13, index
    li    s14, 1 << index
    .holds s14, index
    beqz  inside, 1f
    div   s15, s13, s14, index          ; out of the body
    jump  2f
1:  div   s15, s14, s13, index          ; into it
2:  vput  v9, s15, x
    .holds s15, index
    .holds v9, index
    li    s14, 1:dir
    .holds s14, dir
    mul   s12, cosine, cosine, dir
    .holds s12, dir
    sub   s12, s14, s12
    mul   s12, s12, s15, dir
    .holds s12, index
    mul   s12, s12, s15, index + index - dir
    .holds s12, dir
    sub   s12, s14, s12
    bltz  s12, 3f
    wextend w0, s12, dir
    call  link_leaf, sqrt
    scale_vector v7, facing, cosine, dir
    .holds v7, dir
    scale_vector v8, facing, s12, dir
    .holds v8, dir
    add_vectors v7, direction, v7
    vget  s12, v9, x
    .holds s12, index
    scale_vector v7, v7, s12, index
    subtract direction, v7, v8
    vmov  origin, behind
    movi  s12, 1
    .holds s12
3:  ret   link_node
.endfunc
