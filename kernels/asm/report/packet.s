; Tests every triangle of the packet: a counter and a comparison a triangle, one more to end the loop, and one with the nearest hit
; (Annex II: 40 additions, 81 comparisons and 40 triangle tests for 40 triangles). No tie rule: the first of equal hits stays.
; In: packet_count, packet_refs, near, near_t. Out: near, near_t, near_slot. Returns by link_packet.
; Scratch: s12 to s15 and what triangle needs; packet_count and packet_refs are used up.
.func packet
    mov   s14, s0                       ; triangles that have been tested
1:  bge   s14, packet_count, 3f
    next_reference
    movi  s12, sizeof(triangle)
    load  slot, s15, s12
    wait_for_load
    call  link_step, triangle
    .holds s12, t
    iaddi s14, s14, 1
    bge   s12, near_t, 1b
    mov   near_t, s12
    mov   near, s15
    mov   s12, slot
    .holds s12
    mov   slot, near_slot
    mov   near_slot, s12
    jump  1b
3:  ret   link_packet
.endfunc
