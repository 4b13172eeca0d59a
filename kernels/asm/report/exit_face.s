; Where the ray leaves the packet: all six crossings with its planes, then of those by which the ray leaves (n . u > 0) the nearest one.
; A rounded point may lie beside the surface that it should be in, and none of the six in any: so each is brought into the packet
; instead of being asked, and its coordinate on the plane is the plane itself. Report 3.1.1, 5.3.4, Annex I.
;
; In: origin, direction, box_low, box_high. Out: exit_axis, exit_plane, exit_t, exit_point; for a direction of 0 exit_axis = 3 and
; exit_plane = 0. Returns by link_step. Scratch: s12, s14, s15, s17, s18, v6 to v8.

; The crossing with one of the planes. Takes the place of the nearest one so far when it is no farther.
.macro leave_by k, outward, corner
    crossing \k, \outward, \corner, beside_\@
    blez  s14, beside_\@
  .rept 2, j
    vget  s12, v8, (\k + 1 + j) % 3
    vget  s17, box_low, (\k + 1 + j) % 3
    max   s12, s12, s17
    vget  s17, box_high, (\k + 1 + j) % 3
    min   s12, s12, s17
    vput  v8, s12, (\k + 1 + j) % 3
  .endr
    blt   exit_t, s15, beside_\@
    mov   exit_t, s15
    movi  exit_axis, \k
    vget  exit_plane, \corner, \k
    vmov  exit_point, v8
    vput  exit_point, exit_plane, \k
beside_\@:
.endm

.func exit_face
    .holds exit_t, t
    .holds exit_point, pos
    .holds v6, dir
    .holds v8, pos
    .holds s15, t
    li    exit_t, MISSED
    movi  exit_axis, 3
    mov   exit_plane, s0
    leave_by 0, -1, box_low
    leave_by 0, 1, box_high
    leave_by 1, -1, box_low
    leave_by 1, 1, box_high
    leave_by 2, -1, box_low
    leave_by 2, 1, box_high
    ret   link_step
.endfunc
