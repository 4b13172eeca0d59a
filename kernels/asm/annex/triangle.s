; Driver for the ray-triangle test: a hit, a miss, a parallel ray and a triangle without area.
.entry driver
.func driver
    .holds origin, pos
    .holds direction, dir
    movi  slot, FIRST
1:  lv    origin, ABOVE(s0)
    lv    direction, DOWN(s0)
    call  link_step, triangle
    lea   slot, sizeof(triangle)(slot)
    movi  s20, LAST
    bltu  slot, s20, 1b
    halt
.endfunc
.buffer
DOWN:  .fixed dir, 0, 0, -1
ABOVE: .fixed pos, 0, 0, 0.75
FIRST: .half -ONE/2, -ONE/2, 0, ONE/2, -ONE/2, 0, 0, ONE/2, 0
       .space sizeof(triangle) - 18
       .half ONE/4, ONE/4, 0, ONE/2, ONE/4, 0, ONE/4, ONE/2, 0
       .space sizeof(triangle) - 18
       .half ONE/4, 0, 0, ONE/4, ONE/4, 0, ONE/4, 0, ONE/4
       .space sizeof(triangle) - 18
       .half ONE/4, 0, 0, ONE/4, 0, 0, ONE/4, 0, 0
       .space sizeof(triangle) - 18
LAST:
.text
