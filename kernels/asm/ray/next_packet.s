; The packet after the current one, or packet_count = -1 when the search is over: the ray leaves the scene, any hit will do and there
; is one, or the nearest hit is surely nearer than the plane by which the ray leaves the packet.
; In: the ray, the walk's notes, near, near_t, any_hit. Out: the packet and the notes. Returns by link_packet. Report, pseudo codes 2
; and 3. Scratch: s12 to s15, v6, v7, w0 to w2.
.func next_packet
    walk_names
    .holds box_low
    .holds v6, pos
    .holds v7, pos
    lwide came_by, NOTES + note.plane(last_note)
.if SKIP_ANY_HIT
    beqz  any_hit, 1f
    bnez  near, 4f
1:
.endif
.if SKIP_BEYOND
    rbefore s12, origin, came_by, near_t, dir + t - pos
    bnez  s12, 4f
.endif
    beqz  last_note, 3f
    lw    packet_refs, NOTES + note.far(last_note)
    lea   last_note, -sizeof(note)(last_note)
    lwide leaves_by, NOTES + note.plane(last_note)
2:  call  link_step, descend
    ret   link_packet
3:  begin_walk 4f
.if SKIP_BEYOND
    rbefore s12, origin, came_by, near_t, dir + t - pos
    beqz  s12, 2b
.else
    jump  2b
.endif
4:  movi  packet_count, -1
    ret   link_packet
.endfunc
