; Whitted's local term at the point: colour (ambient + kd sum over visible lights of (N . L) light colour). One shadow ray a light that
; the surface faces. Report 4.3. In: point, facing, the material at MATERIAL_AT. Out: local_colour. Returns by link_shade.
; Uses up the ray, the packet and the hit. Scratch: v6 to v17, v25 to v27, s12 to s15, w0, w1.
.func shade
    vmov  v25, zero_vector                  ; sum over the lights
.if LIGHTS > 0
    movi  s12, LIGHTS_AT
    sw    s12, SHADE_LIGHT(s0)
shade_light:
  .if !LIGHTS_LOCAL
    lw    s13, SHADE_LIGHT(s0)
    li    s12, LIGHTS_BUS - LIGHTS_AT
    addr  s13, s13, s12
    movi  s12, LIGHT_SLOT
    movi  s14, sizeof(light)
    load  s12, s13, s14
  .else
    lw    s12, SHADE_LIGHT(s0)
  .endif
    lv    v26, light.position(s12)
    vsub  v26, v26, point                   ; to the light
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
    vdot  s13, facing, v6, dir
  .if !SKIP_UNLIT
    lwide w0, SHADE_FACING(s0)
    bwgez w0, 1f
    mov   s13, s0
1:
  .endif
    sw    s13, SHADE_COSINE(s0)
    vmov  origin, point
    vmov  direction, v6
    vdot  near_t, v6, v26, dir + pos - t
    mov   near, s0
    movi  any_hit, 1
    call  link_packet, own_packet
    call  link_trace, trace
    bnez  near, shade_next
    lw    s13, SHADE_COSINE(s0)
  .if !LIGHTS_LOCAL
    movi  s12, LIGHT_SLOT
  .else
    lw    s12, SHADE_LIGHT(s0)
  .endif
    lv    v6, light.colour(s12)
    vfma  v25, v6, s13, v25, dir
shade_next:
    lw    s12, SHADE_LIGHT(s0)
    lea   s12, sizeof(light)(s12)
    sw    s12, SHADE_LIGHT(s0)
    li    s13, LIGHTS_AT + LIGHTS * sizeof(light)
    bltu  s12, s13, shade_light
.endif
    lw    s12, MATERIAL_AT(s0)
    lw    s13, material.intensity(s12)
    vscale v25, v25, s13, weight
    li    s13, AMBIENT
    vsplat v6, s13
    vadd  v25, v25, v6
    lv    v6, material.colour(s12)
    vmul  local_colour, v6, v25, weight
    ret   link_shade
.endfunc
