; From the root down to the packet that has a point: a comparison a level, and one to know a leaf. A point in the plane of a split goes
; to the side that the ray goes to, of sign D: where D < 0 the point counts as a unit less. Report, pseudo code 2, Annex I.
; In: exit_point (used up), direction. Out: packet_count, packet_refs, box_low, box_high. Returns by link_step. Scratch: s12 to s15.
.func descend
    .holds exit_point, pos
  .rept 3, k
    vget  s12, direction, k
    .holds s12, dir
    bgez  s12, 1f
    vget  s13, exit_point, k
    .holds s13, pos
    isubi s13, s13, 1
    vput  exit_point, s13, k
1:
  .endr
    first_node
descend_node:
    .holds s12
    next_node descend_leaf
    .holds s15, pos
    vgetr s14, exit_point, s12
    .holds s14, pos
    bge   s14, s15, descend_right
    go_left
    jump  descend_node
descend_right:
    go_right
    jump  descend_node
descend_leaf:
    leaf_packet
    ret   link_step
.endfunc
