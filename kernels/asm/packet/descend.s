; Goes down from a node to the first packet that the ray visits between two planes, the one that it came by and the one that it leaves by, which
; is that of the last note. The note of a split is where the walk goes on when the ray is through with the near side.
;
; In: packet_refs = address of the node, came_by, leaves_by (of boxes alone), last_note. Out: the packet, last_note. Returns by link_step.
; Scratch: s12 to s15, split, came_by, leaves_by.
.func descend
    walk_names
    .holds origin, pos
    .holds direction, dir
.if LAYOUT_REPORT
    walk_boxes
.else
    .assert NOTES == 0, "rwalk takes the last note by its address, which last_note is only where notes begin at 0"
    walk_down
.endif
    ret   link_step
.endfunc
