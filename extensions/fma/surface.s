; The point that was hit, moved off the surface to both sides, the normal there, and the material.
; In: origin, direction, near_t, near_slot. Out: point, behind, facing, cosine, incident, material. Returns by link_shade.
; Scratch: v6 to v11, s12 to s15, w0 to w4.
;
; The point is rounded, so it may lie in the surface or beyond it. A point moves along the normal's major axis by the fewest units, 0 or
; more, for which it lies strictly on its side of the triangle's plane, where the triangle test cannot find it again.

; Units up, s14, from a point at height s13 to strictly above the plane: the smallest whole number above -height, which is at most
; (SIDE_MARGIN - s13) / 2^SIDE_FRACTION. With 8 fraction bits, a height of -0.5 is -128: (2 + 128) >> 8 is 0, so 1 unit; in the plane
; it is 0: 1 unit; at 1 it is 256: (2 - 256) >> 8 is -1, so 0 units.
.macro units_up
    movi  s14, SIDE_MARGIN
    isub  s14, s14, s13
    srai  s14, s14, SIDE_FRACTION
    iaddi s14, s14, 1
    bgez  s14, up_\@
    mov   s14, s0
up_\@:
.endm

; Units down, s14, to strictly below the plane.
.macro units_down
    iaddi s14, s13, SIDE_MARGIN
    srai  s14, s14, SIDE_FRACTION
    iaddi s14, s14, 1
    bgez  s14, down_\@
    mov   s14, s0
down_\@:
.endm

; The point that was hit, v9, moved up, or down, along axis s12. Scratch: s14, s15.
.macro move_up place
    units_up
    vgetr s15, v9, s12
    add   s15, s15, s14
    vmov  \place, v9
    vputr \place, s15, s12
.endm
.macro move_down place
    units_down
    vgetr s15, v9, s12
    sub   s15, s15, s14
    vmov  \place, v9
    vputr \place, s15, s12
.endm

.func surface
    call  link_packet, normal
    vmov  incident, direction
;-    vscale v9, direction, near_t, t + dir - pos
;-    .holds v9, pos
;-    vadd  v9, origin, v9
    vfma  v9, direction, near_t, origin, t + dir - pos ;+
    ; Height of the point over the plane along the axis: the determinant of both edges and the way from a corner to the point, by the
    ; component of the edges' cross product. Its sign does not depend on the order of the corners.
    load_triangle near_slot
    .holds v6, pos
    .holds v7, pos
    .holds v8, pos
    vsub  v7, v7, v6
    vsub  v8, v8, v6
    vsub  v10, v9, v6
    .holds v10, pos
    wcross w0, v7, v8
    wmixed w3, w0, v10, SIDE_SHIFT
    vmajor s12, facing
    vmov  v11, zero_vector
    movi  s13, 1
    vputr v11, s13, s12
    wmixed w4, w0, v11, 0
    wdiv  s13, w3, w4, SIDE_SHIFT + SIDE_FRACTION
    ; The side of the ray is up where the normal that faces it points up.
    vgetr s14, facing, s12
    bltz  s14, surface_down
    move_up point
  .if HAS_GLASS
    move_down behind
  .endif
    jump  surface_moved
surface_down:
    move_down point
  .if HAS_GLASS
    move_up behind
  .endif
surface_moved:
    load_material
    ret   link_shade
.endfunc
