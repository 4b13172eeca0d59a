; Driver for a pixel: SURFACES of them, one behind the other, that reflect and let light through. Up to 5 reflections below the camera ray
; there are 1 + 1 + 2 + 3 + 6 + 10 ways back and forth between surfaces without end; the number that gives 22 nodes is searched. All 40
; triangles are in one packet and are tested by each ray.
.entry driver
.func driver
    .holds origin, pos
    .holds direction, dir
    begin_triangles
    movi  s23, -2 * ONE / 5
    store_triangles SURFACES, SURFACE, "step_z SURFACE"
    movi  s23, ONE / 64
    store_triangles PACKET - SURFACES, ASIDE, "step_z ASIDE"
    root_packet
    trace_pixel
.endfunc
.buffer
START:   .fixed pos, -0.25, -0.5, 1.25
WAY:     .fixed dir, 0.13333333333, 0.33333333333, -0.93333333333
SURFACE: .half -9*ONE/10, -9*ONE/10, 4*ONE/5, 9*ONE/10, -9*ONE/10, 4*ONE/5, 0, 9*ONE/10, 4*ONE/5
         .space sizeof(triangle) - 18
ASIDE:   .half ONE-20, -ONE/2, -ONE/2, ONE-10, -ONE/2, -ONE/2, ONE-20, -ONE/4, -ONE/2
         .space sizeof(triangle) - 18
.text
