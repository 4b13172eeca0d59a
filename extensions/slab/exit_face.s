; The plane through which the ray leaves the packet: the nearest of the three ahead, chosen without division by comparing products,
; run_j |D_k| with run_k |D_j|. Of planes of axes a < b met at the same t, a is first exactly when D_a > 0 (the direction is taken
; as moved by (e, e^2, e^3), as in triangle); an axis with D = 0 is never left by. Exact: the products need n + m bits of 2 x word.
;
; In: origin, direction, steep, backwards, box_low, box_high. Out: exit_axis, exit_plane, exit_run, exit_slope. Returns by link_step.
; Scratch: v6.
.func exit_face
    rleave exit_axis, v6, origin, box_low   ; origin and direction are neighbours, and so are the corners of the box
    vget  exit_run, v6, x
    vget  exit_slope, v6, y
    vget  exit_plane, v6, z
    ret   link_step
.endfunc
