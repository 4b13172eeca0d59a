; Driver for ray against node: rays in all octants from inside a box, none of them parallel to a plane.
.entry driver
.func driver
    .holds origin, pos
    .holds direction, dir
    movi  s20, WAYS
    lv    box_low, LOW(s0)
    lv    box_high, HIGH(s0)
    lv    origin, START(s0)
1:  lvp   direction, 12(s20)
    call  link_step, exit_face
    movi  s21, WAYS_END
    bltu  s20, s21, 1b
    halt
.endfunc
.buffer
LOW:   .fixed pos, -0.5, -0.25, -0.75
HIGH:  .fixed pos, 0.5, 0.75, 0.25
START: .fixed pos, 0.125, 0.0625, -0.3125
WAYS:  .fixed dir, 0.28571428571, 0.42857142857, 0.85714285714
       .fixed dir, -0.28571428571, 0.42857142857, 0.85714285714
       .fixed dir, 0.85714285714, -0.28571428571, 0.42857142857
       .fixed dir, 0.42857142857, 0.85714285714, -0.28571428571
       .fixed dir, -0.42857142857, -0.28571428571, 0.85714285714
       .fixed dir, -0.85714285714, 0.42857142857, -0.28571428571
       .fixed dir, 0.28571428571, -0.85714285714, -0.42857142857
       .fixed dir, -0.42857142857, -0.85714285714, -0.28571428571
WAYS_END:
.text
