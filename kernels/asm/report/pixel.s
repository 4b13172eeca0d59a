; A work item of a core: receives pixel, ray and first packet, sends the colour. Report, pseudo code 5.
.entry pixel
.func pixel
    recv5 message, s12
    vget  packet_count, message, 1
    vget  packet_refs, message, 2
    movi  slot, SLOT
    movi  near_slot, NEAR_SLOT
    vmov  pixel_colour, zero_vector
    .holds pixel_colour, colour
.if HAS_TREE
    call  link_tree, ray_tree
.else
    seek_nearest
    call  link_trace, trace
  .if !HAS_BACKGROUND
    beqz  near, 1f
  .endif
    call  link_node, contribution
.endif
1:  vmov  pixel_head, message
    cores s12
    send2 s12, pixel_head
    halt
.endfunc
