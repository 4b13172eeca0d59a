; Driver for the normal: a large triangle, a small one, a sliver and one without area.
.entry driver
.func driver
    .holds facing, dir
    movi  near_slot, FIRST
1:  call  link_packet, normal
    lea   near_slot, sizeof(triangle)(near_slot)
    movi  s20, LAST
    bltu  near_slot, s20, 1b
    halt
.endfunc
.buffer
FIRST: .half -ONE/2, -ONE/3, 0, ONE/2, -ONE/2, ONE/5, 0, ONE/2, -ONE/7
       .space sizeof(triangle) - 18
       .half 5, 6, 7, 6, 8, 7, 5, 6, 9
       .space sizeof(triangle) - 18
       .half -ONE/2, 0, 0, ONE/2, 1, 0, 0, 1, 0
       .space sizeof(triangle) - 18
       .half ONE/4, 0, 0, ONE/4, 0, 0, ONE/4, 0, 0
       .space sizeof(triangle) - 18
LAST:
.text
