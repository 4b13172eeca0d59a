; Driver for the first packet: a camera ray from outside the scene's box, a tree of 16 levels, to the right at the
; first RIGHTS and then to the left.
.entry driver
.func driver
    .holds origin, pos
    .holds direction, dir
    store_path
    lv    origin, START(s0)
    lv    direction, WAY(s0)
    call  link_packet, first_packet
    halt
.endfunc
.buffer
START: .fixed pos, -0.5, -0.25, 1.25
WAY:   .fixed dir, 0.28571428571, 0.42857142857, -0.85714285714
RIGHTS: .word 0
PATH_NODE: .space sizeof(node)
.text
