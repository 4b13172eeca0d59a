; The first packet of a camera ray, which may start outside the scene's box, or packet_count = -1 when it misses the box. Report, pseudo
; code 4. In: origin, direction. Out: the packet; box_low = the plane by which the ray leaves it (coordinate, axis). Returns by
; link_packet. Scratch: s12 to s15, v6, v7, w0 to w2.
.func first_packet
    walk_names
    .holds box_low
    .holds v6, pos
    .holds v7, pos
    enter_scene 1f
    lwide came_by, NOTES + note.plane(last_note)
first_leave:
    wlow  s12, came_by
    vput  box_low, s12, 0
    whigh s12, came_by
    vput  box_low, s12, 1
    ret   link_packet
1:
.if SKIP_MISSED
    movi  packet_count, -1
    ret   link_packet
.else
    ; A packet is searched all the same, and left as if by the scene's box.
    rexit came_by, origin, v6
  .if LAYOUT_REPORT
    first_node
2:  next_node 3f
    go_left
    jump  2b
3:  lw    packet_refs, node.trig(packet_count)
    lhu   packet_count, node.pnum(packet_count)
  .else
    li    packet_refs, ROOT
2:  fetch_node split, packet_refs
    whigh s12, split
    andi  s13, s12, 3
    xor   packet_refs, s12, s13
    isubi s13, s13, 3
    bnez  s13, 2b
    wlow  packet_count, split
  .endif
    jump  first_leave
.endif
.endfunc
