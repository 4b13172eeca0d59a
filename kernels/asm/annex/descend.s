; Driver for the walk down the tree: 16 levels, to the left at each.
.entry driver
.func driver
    .holds origin, pos
    .holds direction, dir
    store_path
    lv    exit_point, START(s0)
    lv    direction, WAY(s0)
    call  link_step, descend
    halt
.endfunc
.buffer
START: .fixed pos, -0.25, 0.125, 0.5
WAY:   .fixed dir, 0.28571428571, 0.42857142857, 0.85714285714
PATH_NODE: .space node.x1
       .half 9 * ONE / 10
       .space sizeof(node) - node.x1 - 2
.text
