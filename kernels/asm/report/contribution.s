; Adds what a ray sees, times the weight of the path, to the pixel. Report, pseudo code 5.
; In: the ray and its hit (near = 0: none, then there is a background), weight_now. Out: pixel_colour. Returns by link_node.
.func contribution
    .holds local_colour, colour
.if HAS_BACKGROUND
    bnez  near, 1f
    lv    local_colour, BACKGROUND(s0)
    jump  2f
1:
.endif
    call  link_shade, shade
2:
.if HAS_TREE
    scale_vector local_colour, local_colour, weight_now, weight
.endif
    add_vectors pixel_colour, pixel_colour, local_colour
    ret   link_node
.endfunc
