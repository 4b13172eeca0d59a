; The plane through which the ray leaves the packet.
; In: origin, direction, steep, box_low, box_high. Out: exit_axis, exit_plane, exit_run, exit_slope. Returns by link_step.
; Scratch: s12, w0.
.func exit_face
    .holds box_low
    rexit w0, origin, box_low
    whigh exit_axis, w0
    wlow  exit_plane, w0
    vgetr s12, origin, exit_axis
    .holds s12, pos
    sub   exit_run, exit_plane, s12
    abs   exit_run, exit_run
    vgetr exit_slope, steep, exit_axis
    ret   link_step
.endfunc
