; Unit vector in the direction of v6, with the instruction. In: v6. Out: v6. Returns by link_step.
.func unit
    vunit v6, v6, dir
    ret   link_step
.endfunc
