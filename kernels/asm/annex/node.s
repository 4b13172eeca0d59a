; Driver for a node of the ray tree: a surface that reflects, lets light through and sees the light, in a packet of 40 triangles. Each ray
; tests all of them; neither child meets anything.
.entry driver
.func driver
    .holds origin, pos
    .holds direction, dir
    begin_triangles
    movi  s23, ONE / 64
    store_triangles 1, SURFACE, "step_z SURFACE"
    store_triangles PACKET - 1, ASIDE, "step_z ASIDE"
    root_packet
    trace_pixel
.endfunc
.buffer
START:   .fixed pos, -0.1875, -0.25, 1.25
WAY:     .fixed dir, 0.13333333333, 0.33333333333, -0.93333333333
SURFACE: .half -ONE/2, -ONE/2, 0, ONE/2, -ONE/2, 0, 0, 3*ONE/4, 0
         .space sizeof(triangle) - 18
ASIDE:   .half ONE-20, -ONE/2, -ONE/2, ONE-10, -ONE/2, -ONE/2, ONE-20, -ONE/4, -ONE/2
         .space sizeof(triangle) - 18
.text
