; Driver for the packet: 40 triangles, all tested, each a little nearer than the one before.
.entry driver
.func driver
    .holds origin, pos
    .holds direction, dir
    begin_triangles
    movi  s23, ONE / 64
    store_triangles PACKET, PATTERN, "step_z PATTERN"
    lv    origin, ABOVE(s0)
    lv    direction, DOWN(s0)
    seek_nearest
    movi  packet_count, PACKET
    li    packet_refs, REFERENCES_AT
    call  link_packet, packet
    halt
.endfunc
.buffer
DOWN:    .fixed dir, 0, 0, -1
ABOVE:   .fixed pos, 0, 0, 0.9
PATTERN: .half -ONE/2, -ONE/2, 0, ONE/2, -ONE/2, 0, 0, ONE/2, 0
         .space sizeof(triangle) - 18
.text
