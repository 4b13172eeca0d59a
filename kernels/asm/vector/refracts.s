; Whether the ray goes through the surface: the weight of the refracted ray (0: none), and for total reflection the weight that the
; reflected ray takes over. k = 1 - eta^2 (1 - c^2) < 0 is total reflection. Report 4.2, corrected.
; In: weight_now, inside, cosine, the material. Out: refracted_weight, reflected_weight (what is added), k and eta in the node.
; Returns by link_node. Scratch: s12 to s15, w0, w1.
.func refracts
    .holds refracted_weight, weight
    mov   reflected_weight, s0
    mov   refracted_weight, s0
    lw    s12, MATERIAL_AT(s0)
    lw    s13, material.transmission(s12)
    .holds s13, weight
.if SKIP_WEIGHTLESS
    beqz  s13, 3f
.endif
    mul   refracted_weight, weight_now, s13, weight
    lw    s14, material.index(s12)
    .holds s14, index
    bnez  inside, 1f
    lw    s14, material.inverse_index(s12)
1:  mul   s13, cosine, cosine, dir
    .holds s13, dir
    li    s15, 1:dir
    .holds s15, dir
    sub   s13, s15, s13
    mul   s13, s13, s14, dir
    .holds s13, index
    wmul  w0, s13, s14                      ; eta^2 (1 - c^2) may be more than a word holds, so it is compared as it is
    wextend w1, s15, index + index - dir
    bwlt  w1, w0, 2f
    wround s13, w0, index + index - dir
    .holds s13, dir
    sub   s13, s15, s13
    sw    s13, raynode.k(node)
    sw    s14, raynode.eta(node)
    ret   link_node
2:  mov   reflected_weight, refracted_weight
.if SKIP_WEIGHTLESS
    mov   refracted_weight, s0
.else
    movi  refracted_weight, -1              ; there is no such ray, not even one of weight 0
.endif
3:  ret   link_node
.endfunc
