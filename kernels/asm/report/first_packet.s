; The first packet of a ray that may start outside the scene's box, or packet_count = -1 when it misses the box: of the crossings with
; the six planes that lie in the box's surface the nearest one. Report, pseudo code 4. An origin inside the box has its own packet.
; In: origin, direction. Out: the packet and its box. Returns by link_packet. Scratch: s12 to s15, s17, s18, v6 to v8.

; The crossing with one of the planes, when it is in the surface and no farther than the nearest one so far.
.macro enter_by k, outward, corner
    crossing \k, \outward, \corner, beside_\@
    blez  s15, beside_\@
  .rept 2, j
    vget  s12, v8, (\k + 1 + j) % 3
    vget  s17, box_low, (\k + 1 + j) % 3
    blt   s12, s17, beside_\@
    vget  s17, box_high, (\k + 1 + j) % 3
    blt   s17, s12, beside_\@
  .endr
    blt   exit_t, s15, beside_\@
    mov   exit_t, s15
    movi  exit_axis, \k
    vget  s12, \corner, \k
    vmov  exit_point, v8
    vput  exit_point, s12, \k
beside_\@:
.endm

.func first_packet
    .holds exit_t, t
    .holds exit_point, pos
    lv    box_low, ROOT_LOW(s0)
    lv    box_high, ROOT_HIGH(s0)
    vmov  exit_point, origin
  .rept 3, k
    vget  s12, origin, k
    .holds s12, pos
    vget  s13, box_low, k
    .holds s13, pos
    blt   s12, s13, first_outside
    vget  s13, box_high, k
    blt   s13, s12, first_outside
  .endr
    jump  first_found
first_outside:
    .holds v8, pos
    .holds s15, t
    li    exit_t, MISSED
    movi  exit_axis, 3
    enter_by 0, -1, box_low
    enter_by 0, 1, box_high
    enter_by 1, -1, box_low
    enter_by 1, 1, box_high
    enter_by 2, -1, box_low
    enter_by 2, 1, box_high
    movi  s12, 3
    bne   exit_axis, s12, first_found
    movi  packet_count, -1
    ret   link_packet
first_found:
    call  link_step, descend
    ret   link_packet
.endfunc
