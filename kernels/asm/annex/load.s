; A pixel of the report's estimate as a load: 20 times 10,150 clocks of computing, then a transfer of 1,240 octets.
; Report 6.1: 203,000 clocks of computing and 49,600 of transfers at two clocks an octet.
.entry pixel
.format dir, 30
.func pixel
    .holds v0, dir
    .holds v1, dir
    recv5 v0, s20
    movi  s3, 1240
.rept 20
    movi  s1, 50
1:                              ; 50 times 203 operations:
  .rept 22
    vcross v6, v0, v1, dir      ; 22 times 9,
  .endr
    .holds v6, dir
    vadd  v6, v6, v1            ; 3,
    isubi s1, s1, 1             ; 1
    bnez  s1, 1b                ; and 1
    load  s0, s0, s3
.endr
    send2 s20, v0
    halt
.endfunc
