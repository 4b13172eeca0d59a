; Follows the ray of a node and adds what it sees, times the weight of the path, to the pixel. Report, pseudo code 5.
; In: the ray and its first packet, weight_now. Out: pixel_colour, near (0: nothing was hit), and the surface. Returns by link_node.
.func contribution
    seek_nearest
    bltz  packet_count, 1f
    call  link_trace, trace
    beqz  near, 1f
    call  link_shade, surface
    call  link_shade, shade
    movi  near, 1
.if HAS_TREE
    vscale local_colour, local_colour, weight_now, weight
.endif
    vadd  pixel_colour, pixel_colour, local_colour
    ret   link_node
1:
.if HAS_BACKGROUND
    lv    v6, BACKGROUND(s0)
    .holds v6, colour
  .if HAS_TREE
    vscale v6, v6, weight_now, weight
  .endif
    vadd  pixel_colour, pixel_colour, v6
.endif
    ret   link_node
.endfunc
