; Follows the ray from its first packet to the nearest hit, or with any_hit = 1 to any hit nearer than near_t. Report, pseudo code 3.
; In: origin, direction, the first packet and its box (packet_count < 0: none), near_t, near = 0, any_hit.
; Out: near (0: nothing), near_t, near_slot. Returns by link_trace.
.func trace
    .holds near_t, t
    li    steps, MOST_STEPS
    bltz  packet_count, 2f
1:  call  link_packet, packet
    call  link_packet, next_packet
    bgez  packet_count, 1b
2:  ret   link_trace
.endfunc
