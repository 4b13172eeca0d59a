; Tests the triangles of the packet but the last one. Before each test the load of the next triangle begins, which the core does not wait
; for, so that computing and loading go on side by side.
; In: the triangle that comes to slot, its name, left, fills, packet_refs, near, near_t. Out: near, near_t, near_slot; the last triangle that
; comes to slot, and its name. Returns by link_packet. Scratch: s12, s15, coming, comes_to and what triangle needs; left is used up.
.func packet
    .holds name
    .holds fills
    .holds left
    .holds coming
    .holds comes_to
1:  blez  left, 3f
    begin_triangle
    test_triangle
    mov   slot, comes_to
    mov   name, coming
    jump  1b
3:  ret   link_packet
.endfunc
