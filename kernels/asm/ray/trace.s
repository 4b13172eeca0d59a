; Follows the ray from its first packet to the nearest hit, or with any_hit = 1 to any hit nearer than near_t. Report, pseudo code 3.
; In: origin, direction, the first packet (packet_count < 0: none) and the walk's notes, near_t, near = 0, any_hit.
; Out: near (0: nothing), near_t, near_slot. Returns by link_trace.
.func trace
    .holds near_t, t
    bltz  packet_count, 2f
.if SKIP_TESTED
    forget_tested
.endif
1:  call  link_packet, packet
    call  link_packet, next_packet
    bgez  packet_count, 1b
2:  ret   link_trace
.endfunc
