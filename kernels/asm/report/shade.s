; Whitted's local term at the hit: colour (ambient + kd sum over visible lights of (N . L) light colour). One shadow ray a light that
; the surface faces. Report 4.3. In: the ray and its hit (near_t, near_slot). Out: local_colour. Returns by link_shade.
; Uses up the ray, the packet and the hit. Scratch: what surface needs, v9 to v17, v25, v26.
.func shade
    call  link_trace, surface
    vmov  v25, zero_vector              ; sum over the lights
    .holds v25, colour
.if LIGHTS > 0
    first_light
shade_light:
    load_light
  .if HAS_FAR_LIGHTS
    lw    s13, light.scale(s12)         ; the point comes into the light's steps
    .holds s13, dir
    scale_vector v6, point, s13, dir
    subtract v26, v26, v6               ; to the light
  .else
    subtract v26, v26, point            ; to the light
  .endif
    .holds v26, pos
    vnorm v6, s13, v26
    call  link_step, unit
    .holds v6, dir
    dot_product facing, v6, dir
    .holds s12, dir
  .if SKIP_UNLIT
    blez  s12, shade_next
  .else
    beqz  s12, shade_next               ; in the surface, or the light itself: there is no ray
    bgez  s12, 1f
    mov   s12, s0
1:
  .endif
    sw    s12, SHADE_COSINE(s0)
    .holds s12
    dot_product v6, v26, dir + pos - t
    .holds s12, t
    mov   near_t, s12
    far_light
    shadow_ray shade_next
    .holds v6, colour
    .holds s13, dir
    scale_vector v6, v6, s13, dir
    add_vectors v25, v25, v6
shade_next:
    next_light shade_light
.endif
    .holds s12
    lw    s12, MATERIAL_AT(s0)
    lw    s13, material.intensity(s12)
    .holds s13, weight
    scale_vector v25, v25, s13, weight
    li    s13, AMBIENT
    .holds s13, colour
    vsplat v6, s13
    .holds v6, colour
    add_vectors v25, v25, v6
    lw    s12, MATERIAL_AT(s0)
    lv    v6, material.colour(s12)
    .holds v6, weight
  .rept 3, k
    vget  s13, v6, k
    vget  s14, v25, k
    mul   s13, s13, s14, weight
    vput  local_colour, s13, k
  .endr
    ret   link_shade
.endfunc
