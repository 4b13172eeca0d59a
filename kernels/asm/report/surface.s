; The point that was hit, moved off the surface to both sides, the normal there, and the material.
; In: origin, direction, near_t, near_slot. Out: point, behind, facing, cosine >= 0, material. Returns by link_trace.
; Scratch: s12 to s15, s17, s18, v6 to v8, w0 to w5.
.func surface
    call  link_packet, normal
    dot_product facing, direction, dir
    .holds s12, dir
    blez  s12, 1f
  .rept 3, k
    vget  s17, facing, k
    neg   s17, s17
    vput  facing, s17, k
  .endr
    mov   cosine, s12
    jump  2f
1:  neg   cosine, s12
2:  scale_vector v6, direction, near_t, t + dir - pos
    .holds v6, pos
    add_vectors v6, origin, v6
    move_off LITERAL_OFFSET
    load_material
    ret   link_trace
.endfunc
