; The point that was hit, moved off the surface to both sides, the normal there, and the material.
; In: origin, direction, near_t, near_slot. Out: point, behind, facing, cosine, incident, material. Returns by link_shade.
.func surface
    call  link_packet, normal
    vmov  incident, direction
;-    vscale v6, direction, near_t, t + dir - pos
;-    vadd  v6, origin, v6
    vfma  v6, direction, near_t, origin, t + dir - pos ;+
    move_off OFFSET
    load_material
    ret   link_shade
.endfunc
