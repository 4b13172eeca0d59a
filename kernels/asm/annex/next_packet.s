; Driver for the next packet: the ray has hit nothing yet and does not leave the scene, a tree of 16 levels, to the right at the
; first RIGHTS and then to the left.
.entry driver
.func driver
    .holds origin, pos
    .holds direction, dir
    store_path
    lv    origin, START(s0)
    lv    direction, WAY(s0)
    lv    box_low, LOW(s0)
    lv    box_high, HIGH(s0)
    seek_nearest
    movi  steps, 2
    call  link_packet, next_packet
    halt
.endfunc
.buffer
LOW:   .fixed pos, -0.5, -0.25, -0.75
HIGH:  .fixed pos, 0.5, 0.75, 0.25
START: .fixed pos, -0.125, 0.0625, -0.3125
WAY:   .fixed dir, 0.28571428571, 0.42857142857, 0.85714285714
RIGHTS: .word 0
PATH_NODE: .space sizeof(node)
.text
