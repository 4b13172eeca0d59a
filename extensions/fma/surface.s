; The point that was hit, moved off the surface to both sides, the normal there, and the material.
; In: origin, direction, near_t, near_slot. Out: point, behind, facing, cosine, incident, material. Returns by link_shade.
.func surface
    call  link_packet, normal
    vmov  incident, direction
    vfma  v6, direction, near_t, origin, t + dir - pos
    ; The point is rounded, so it may lie on the wrong side: it moves along the normal's major axis by more than that error.
    vmajor s12, facing
    vgetr s13, facing, s12
    vgetr s14, v6, s12
    movi  s15, OFFSET
    bgez  s13, 1f
    movi  s15, -OFFSET
1:  add   s13, s14, s15
    vmov  point, v6
    vputr point, s13, s12
.if HAS_GLASS
    sub   s13, s14, s15
    vmov  behind, v6
    vputr behind, s13, s12
.endif
    load_material
    ret   link_shade
.endfunc
