; The plane through which the ray leaves the packet: the nearest of the three ahead, chosen without division by comparing products,
; run_j |D_k| with run_k |D_j|. Of planes of axes a < b met at the same t, a is first exactly when D_a > 0 (the direction is taken
; as moved by (e, e^2, e^3), as in triangle); an axis with D = 0 is never left by. Exact: the products need n + m bits of 2 x word.
;
; In: origin, direction, steep, backwards, box_low, box_high. Out: exit_axis, exit_plane, exit_run, exit_slope. Returns by link_step.
;-; Scratch: v6, v7, v8, s12 to s15, w0, w1.
; Scratch: v6. ;+
.func exit_face
;-    vmov  v6, box_high
;-    vselect v6, box_low, backwards
;-    .holds v6, pos
;-    vsub  v7, v6, origin
;-    .holds v7, pos
;-    vneg  v8, v7
;-    .holds v8, pos
;-    vselect v7, v8, backwards
;-    vget  exit_run, v7, x
;-    vget  exit_slope, steep, x
;-    movi  exit_axis, 0
;-    vget  s12, v7, y
;-    .holds s12, pos
;-    vget  s13, steep, y
;-    .holds s13, dir
;-    wmul  w0, exit_run, s13
;-    wmul  w1, s12, exit_slope
;-    bwlt  w0, w1, 2f
;-    bwlt  w1, w0, 1f
;-    andi  s14, backwards, 1
;-    beqz  s14, 2f
;-1:  movi  exit_axis, 1
;-    mov   exit_run, s12
;-    mov   exit_slope, s13
;-2:  vget  s12, v7, z
;-    vget  s13, steep, z
;-    wmul  w0, exit_run, s13
;-    wmul  w1, s12, exit_slope
;-    bwlt  w0, w1, 4f
;-    bwlt  w1, w0, 3f
;-    srl   s14, backwards, exit_axis
;-    andi  s14, s14, 1
;-    beqz  s14, 4f
;-3:  movi  exit_axis, 2
;-    mov   exit_run, s12
;-    mov   exit_slope, s13
;-4:  vgetr exit_plane, v6, exit_axis
    rleave exit_axis, v6, origin, box_low   ; origin and direction are neighbours, and so are the corners of the box ;+
    vget  exit_run, v6, x ;+
    vget  exit_slope, v6, y ;+
    vget  exit_plane, v6, z ;+
    ret   link_step
.endfunc
