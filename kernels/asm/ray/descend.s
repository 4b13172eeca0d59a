; Goes down from a node to the first packet that the ray visits between two planes, the one that it came by and the one that it leaves
; by. Where it visits both sides of a split, the split is where it leaves the near side: the walk notes it with the far side, and
; goes on there when it is through with the near one. So a node is read at most once a ray, boxes are not needed, and a walk ends.
;
; In: packet_refs = address of the node, came_by, leaves_by, last_note. Out: the packet, last_note: the note of the plane by which the ray
; leaves the packet. Returns by link_step. Scratch: s12 to s15, split, came_by, leaves_by.

.func descend
    walk_names
    .holds origin, pos
    .holds direction, dir
.if LAYOUT_REPORT
    walk_boxes
.else
descend_node:
    fetch_node split, packet_refs
    rstep packet_refs, s14, origin, split, sizeof(node)
    beqz  s14, descend_node
    bltz  s14, descend_leaf
    note_split
    jump  descend_node
descend_leaf:
    wlow  packet_count, split
.endif
    ret   link_step
.endfunc
