; The packet after the current one, or packet_count = -1 when the search is over: the ray leaves the scene, any hit will do and there
; is one, or the nearest hit is surely nearer than the exit, (t + 1 ulp) |D_k| < run_k.
; In: the ray, the packet's box, near, near_t, any_hit. Out: the packet and its box. Returns by link_packet. Report, pseudo codes 2 and 3.
.func next_packet
    call  link_step, exit_face
.if SKIP_ANY_HIT
    beqz  any_hit, 1f
    bnez  near, 4f
  .if SKIP_BEYOND
    jump  2f
  .endif
1:
.endif
.if SKIP_BEYOND
  .if !SKIP_ANY_HIT
    bnez  any_hit, 2f
  .endif
    beqz  near, 3f
2:  wextend w0, exit_slope, 0
    wmac  w0, near_t, exit_slope            ; (t + 1) |D_k|: t + 1 itself may not fit a word
    wextend w1, exit_run, t + dir - pos
    bwlt  w0, w1, 4f
3:
.endif
    srl   s13, backwards, exit_axis
    andi  s13, s13, 1
    movi  s12, ROOT_HIGH
    element s12, s12, s13, ROOT_LOW - ROOT_HIGH
    element s12, s12, exit_axis, 4
    lw    s12, (s12)
    .holds s12, pos
    beq   s12, exit_plane, 4f
    isubi steps, steps, 1
    beqz  steps, 5f
    call  link_step, descend
    ret   link_packet
4:  movi  packet_count, -1
    ret   link_packet
5:  trap  TRAP_STUCK
.endfunc
