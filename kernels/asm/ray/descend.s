; Goes down from a node to the first packet that the ray visits between two planes, the one that it came by and the one that it leaves
; by. Where it visits both sides of a split, the split is where it leaves the near side: the walk notes it with the far side, and
; goes on there when it is through with the near one. So a node is read at most once a ray, boxes are not needed, and a walk ends.
;
; In: packet_refs = address of the node, came_by, leaves_by, last_note. Out: the packet, last_note: the note of the plane by which the ray
; leaves the packet. Returns by link_step. Scratch: s12 to s15, split, came_by, leaves_by.

; Notes the split, whose far side is at s14. The ray leaves the near side by it.
.macro note_split
    lea   last_note, sizeof(note)(last_note)
    swide split, NOTES + note.plane(last_note)
    sw    s14, NOTES + note.far(last_note)
    wmov  leaves_by, split
.endm

.func descend
.if LAYOUT_REPORT
    mov   s13, packet_refs
    far_node
descend_node:
    next_node descend_leaf
    ori   s14, s12, 4                       ; the left child stands as 4, the right one as 5
    wjoin split, s14, s15
    rstep s12, s14, origin, split, 1
    beqz  s14, 2f
    andi  s14, s14, 1
    beqz  s14, 1f
    right_child
    note_split
    go_left
    jump  descend_node
1:  left_child
    note_split
    go_right
    jump  descend_node
2:  andi  s12, s12, 1
    bnez  s12, 3f
    go_left
    jump  descend_node
3:  go_right
    jump  descend_node
descend_leaf:
    lw    packet_refs, node.trig(packet_count)
    lhu   packet_count, node.pnum(packet_count)
.else
descend_node:
    ldwide split, (packet_refs)
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
