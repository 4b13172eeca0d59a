; The reflected ray, V = 2 (I . N) N - I with I = -D: D - (-2 c) N, since -2 fits the direction format and 2 does not. Report 4.1.
; In: the ray and its hit (near_t, near_slot). Out: origin, direction. Returns by link_node. Scratch: what surface needs.
.func reflect
    call  link_trace, surface
    movi  s13, -2
    mul   s12, cosine, s13, 0
    .holds s12, dir
    scale_vector v6, facing, s12, dir
    .holds v6, dir
    subtract direction, direction, v6
    vmov  origin, point
    ret   link_node
.endfunc
