; Whitted's local term at the point: colour (ambient + kd sum over visible lights of (N . L) light colour). One shadow ray a light that
; the surface faces. Report 4.3. In: point, facing, the material at MATERIAL_AT. Out: local_colour. Returns by link_shade.
; Uses up the ray, the packet and the hit. Scratch: v6 to v17, v25 to v27, s12 to s15, w0, w1.
.func shade
    vmov  v25, zero_vector                  ; sum over the lights
    .holds v25, colour
.if LIGHTS > 0
    first_light
shade_light:
    load_light
  .if HAS_FAR_LIGHTS
    lw    s13, light.scale(s12)             ; the point comes into the light's steps
    .holds s13, dir
    vscale v6, point, s13, dir
    vsub  v26, v26, v6                      ; to the light
  .else
    vsub  v26, v26, point                   ; to the light
  .endif
    .holds v26, pos
    wdot  w0, facing, v26
    wextend w1, s0, 0
  .if SKIP_UNLIT
    bwlt  w1, w0, shade_facing
    jump  shade_next
shade_facing:
  .else
    bweq  w0, w1, shade_next                ; in the surface, or the light itself: there is no ray
    swide w0, SHADE_FACING(s0)
  .endif
    vnorm v6, s13, v26
    call  link_step, unit
    .holds v6, dir
    vdot  s13, facing, v6, dir
    .holds s13, dir
  .if !SKIP_UNLIT
    lwide w0, SHADE_FACING(s0)
    bwgez w0, 1f
    mov   s13, s0
1:
  .endif
    sw    s13, SHADE_COSINE(s0)
    vdot  near_t, v6, v26, dir + pos - t
    far_light
    shadow_ray shade_next
;-    .holds v6, colour
;-    vscale v6, v6, s13, dir
;-    vadd  v25, v25, v6
    vfma  v25, v6, s13, v25, dir ;+
shade_next:
    next_light shade_light
.endif
    lw    s12, MATERIAL_AT(s0)
    lw    s13, material.intensity(s12)
    .holds s13, weight
    vscale v25, v25, s13, weight
    li    s13, AMBIENT
    .holds s13, colour
    vsplat v6, s13
    .holds v6, colour
    vadd  v25, v25, v6
    lv    v6, material.colour(s12)
    .holds v6, weight
    vmul  local_colour, v6, v25, weight
    ret   link_shade
.endfunc
