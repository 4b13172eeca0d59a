; Dot product of v1 and v2 as whole numbers, once by an instruction and once by hand; s10 and s11 are equal, and the counts say what
; each way costs.
.entry start
.func start
    vdot  s10, v1, v2, 0
    call  s31, by_hand
    halt
.endfunc

.func by_hand
    mov   s11, s0
  .rept 3, k
    vget  s12, v1, k
    vget  s13, v2, k
    mul   s12, s12, s13, 0
    add   s11, s11, s12
  .endr
    ret   s31
.endfunc
