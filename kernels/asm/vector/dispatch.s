; The main processor: makes the camera ray of each pixel, finds its first packet, feeds the cores and stores their answers.
.reg pixel_at,  s20
.reg column,    s21
.reg row,       s22
.reg started,   s23        ; cores that have work
.reg target,    s19
.reg pass,      s24        ; 0: the corners, 1: what lies between them; no function of this program uses it
.reg answer,    v18        ; (pixel, -, -) and the colour
.entry dispatch
.func dispatch
    mov   started, s0
.if INTERPOLATES
    mov   pass, s0
dispatch_pass:
.endif
    mov   pixel_at, s0
    li    row, FIRST_ROW
dispatch_row:
    li    column, FIRST_COLUMN
dispatch_pixel:
.if INTERPOLATES
    call  link_node, interpolate
    bnez  s12, dispatch_next
.endif
    call  link_node, camera
    call  link_packet, first_packet
    cores s12
    bge   started, s12, dispatch_wait
    mov   target, started
    iaddi started, started, 1
    jump  dispatch_send
dispatch_wait:
    call  link_node, receive
dispatch_send:
    vput  message, pixel_at, 0
    vput  message, packet_count, 1
    vput  message, packet_refs, 2
    send5 target, message
dispatch_next:
    iaddi pixel_at, pixel_at, 1
    iaddi column, column, 1
    li    s12, FIRST_COLUMN + WIDTH
    blt   column, s12, dispatch_pixel
    iaddi row, row, 1
    li    s12, FIRST_ROW + HEIGHT
    blt   row, s12, dispatch_row
.if INTERPOLATES
    beqz  started, dispatch_drained
.endif
dispatch_drain:
    call  link_node, receive
    isubi started, started, 1
    bnez  started, dispatch_drain
.if INTERPOLATES
dispatch_drained:
    bnez  pass, 1f
    movi  pass, 1
    jump  dispatch_pass
1:
.endif
    halt
.endfunc

; Waits for an answer and stores its colour in the frame. Out: target = the core that is free now. Returns by link_node.
.func receive
    recv2 answer, target
    vget  s12, answer, 0
    li    s13, FRAME
    element s13, s13, s12, 12
    vmov  v20, v19
    .holds v20, colour
    stv   v20, (s13)
    ret   link_node
.endfunc

; The function of column (w2) and row (w3) at \at, w1: first + column x column - row x row. Scratch: w0.
.macro linear at
    lwide w0, \at + linear.column(s0)
    wmulw w0, w0, w2
    lwide w1, \at(s0)
    wadd  w1, w1, w0
    lwide w0, \at + linear.row(s0)
    wmulw w0, w0, w3
    wsub  w1, w1, w0
.endm

; The coordinate of the point in which the ray enters by a face of slope w4, on the axis at \at; to \outside where it passes beside the face.
.macro enter_across at, outside
    linear \at + across.from_high
    bwltz w1, \outside
    linear \at
    bwltz w1, \outside
    wdiv  s12, w1, w4, CAMERA_SHIFT
    .holds s12, pos
    lw    s13, \at + across.low(s0)
    .holds s13, pos
    add   s12, s12, s13
    lw    s13, \at + across.axis(s0)
    .holds s13
    vputr origin, s12, s13
.endm

; The ray of pixel (column, row). Out: origin, direction. Returns by link_node. Scratch: s12, s13, v6, w0 to w4 and that of sqrt.
.func camera
    .holds v6, dir
    wextend w2, column, 0
    wextend w3, row, 0
.if PERSPECTIVE
    ; The way to the pixel, in the direction format with CAMERA_EXTRA more bits, and rounded to the format.
    .rept 3, k
    linear CAMERA_TOWARDS + sizeof(linear) * k
    swide w1, CAMERA_WAY + 8 * k(s0)
    wround s12, w1, CAMERA_EXTRA
    vput  v6, s12, k
    .endr
    ; By its length. Only the length is that of the rounded way, so that the direction itself is rounded once, by the quotient.
    wdot  w0, v6, v6
    call  link_leaf, sqrt
    .holds s12, dir
    wextend w0, s12, CAMERA_EXTRA
    .rept 3, k
    lwide w1, CAMERA_WAY + 8 * k(s0)
    wdiv  s12, w1, w0, dir
    vput  direction, s12, k
    .endr
    lv    origin, CAMERA_EYE(s0)
  .if CAMERA_FACES > 0
    ; The point in which it enters the scene's box is rounded once as well, by the quotients: nothing is lost with the eye's distance.
    wextend w2, column, 0
    wextend w3, row, 0
    .rept CAMERA_FACES, k
    linear CAMERA_FACES_AT + sizeof(face) * k
    bwltz w1, 1f
    bweqz w1, 1f
    wmov  w4, w1
    enter_across CAMERA_FACES_AT + sizeof(face) * k + face.first, 1f
    enter_across CAMERA_FACES_AT + sizeof(face) * k + face.second, 1f
    lw    s12, CAMERA_FACES_AT + sizeof(face) * k + face.at(s0)
    .holds s12, pos
    lw    s13, CAMERA_FACES_AT + sizeof(face) * k + face.axis(s0)
    vputr origin, s12, s13
    ret   link_node
1:
    .endr
    ; It misses the box, and starts behind it on every axis.
    lv    origin, CAMERA_ABOVE(s0)
    vlt   s12, direction, zero_vector
    .holds s12
    lv    v6, CAMERA_BELOW(s0)
    .holds v6, pos
    vselect origin, v6, s12
  .endif
.else
    lwide w0, CAMERA_PITCH(s0)
    wmulw w1, w0, w2
    wmulw w0, w0, w3
    lwide w2, CAMERA_FIRST(s0)
    wadd  w1, w2, w1
    wround s12, w1, CAMERA_EXTRA
    .holds s12, pos
    vput  origin, s12, x
    lwide w2, CAMERA_FIRST + 8(s0)
    wsub  w1, w2, w0
    wround s12, w1, CAMERA_EXTRA
    vput  origin, s12, y
    li    s12, CAMERA_Z
    vput  origin, s12, z
    lv    direction, CAMERA_DIRECTION(s0)
.endif
    ret   link_node
.endfunc
