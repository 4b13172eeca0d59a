; Whether the surface reflects: the weight of the reflected ray (0: none). In: weight_now, the material, reflected_weight = what total
; reflection adds. Out: reflected_weight. Returns by link_node. Scratch: s12, s13.
.func reflects
    lw    s12, MATERIAL_AT(s0)
    lw    s13, material.reflection(s12)
    .holds s13, weight
    mul   s13, s13, weight_now, weight
    add   reflected_weight, reflected_weight, s13
    ret   link_node
.endfunc
