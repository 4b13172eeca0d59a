; Driver for the ray-triangle test: a hit, a miss, a parallel ray and a triangle without area.
.entry driver
.func driver
    lv    direction, DOWN(s0)
    movi  slot, FIRST
1:  lv    origin, ABOVE(s0)
    call  link_step, triangle
    lea   slot, sizeof(triangle)(slot)
    movi  s20, LAST
    bltu  slot, s20, 1b
    halt
.endfunc
.buffer
DOWN:  .fixed dir, 0, 0, -1
ABOVE: .fixed pos, 0, 0, 3
FIRST: .fixed pos, -1, -1, 0, 1, -1, 0, 0, 1, 0
       .half 0
       .fixed pos, 1, 1, 0, 2, 1, 0, 1, 2, 0
       .half 0
       .fixed pos, 1, 0, 0, 1, 1, 0, 1, 0, 1
       .half 0
       .fixed pos, 1, 0, 0, 1, 0, 0, 1, 0, 0
       .half 0
LAST:
.text
