; Whether the pixel (column, row) is done without a ray. Every second pixel of every second row, and those of the last column and row,
; are corners: the first pass draws them. In the second pass a pixel between corners gets their mean when they agree in every component.
; Report 6.4 asks what that is worth.
; In: pixel_at, column, row, pass. Out: s12 = 1 when it is done. Returns by link_node. Scratch: s11 to s15, v6 to v13.

; The corners to the left and to the right of address s14 go to the buffer at \at.
.macro read_corners at
    movi  s12, sizeof(pixel)
    isub  s14, s14, s15
    li    s11, \at
    load  s11, s14, s12
    addr  s14, s14, s15
    addr  s14, s14, s15
    li    s11, \at + sizeof(pixel)
    load  s11, s14, s12
    isub  s14, s14, s15
.endm

.func interpolate
    li    s12, FIRST_COLUMN
    isub  s13, column, s12
    andi  s15, s13, 1                       ; whether the corners lie beside the pixel
    li    s12, WIDTH - 1
    bne   s13, s12, 1f
    mov   s15, s0
1:  li    s12, FIRST_ROW
    isub  s13, row, s12
    andi  s14, s13, 1                       ; whether they lie above and below
    li    s12, HEIGHT - 1
    bne   s13, s12, 2f
    mov   s14, s0
2:  or    s12, s14, s15
    bnez  s12, interpolate_between
    mov   s12, pass
    ret   link_node
interpolate_between:
    bnez  pass, interpolate_corners
    movi  s12, 1
    ret   link_node
interpolate_corners:
    mov   s13, s0
    beqz  s14, 3f
    li    s13, sizeof(pixel) * WIDTH
3:  element s15, s0, s15, sizeof(pixel)
    li    s14, FRAME
    element s14, s14, pixel_at, sizeof(pixel)
    isub  s14, s14, s13
    read_corners CORNERS
    addr  s14, s14, s13
    addr  s14, s14, s13
    read_corners CORNERS + 2 * sizeof(pixel)
    lv    v6, CORNERS(s0)
    .holds v6, colour
    .holds v7, colour
    .holds v8, colour
    .holds v9, colour
    lv    v7, CORNERS + sizeof(pixel)(s0)
    lv    v8, CORNERS + 2 * sizeof(pixel)(s0)
    lv    v9, CORNERS + 3 * sizeof(pixel)(s0)
    vmin  v10, v6, v7
    .holds v10, colour
    .holds v11, colour
    vmin  v11, v8, v9
    vmin  v10, v10, v11
    vmax  v12, v6, v7
    .holds v12, colour
    .holds v13, colour
    vmax  v13, v8, v9
    vmax  v12, v12, v13
    vsub  v12, v12, v10
    li    s12, AGREEMENT
    vsplat v13, s12
    vlt   s12, v13, v12
    bnez  s12, interpolate_apart
    li    s12, 0.25:weight
    .holds s12, weight
    vscale v6, v6, s12, weight
    vscale v7, v7, s12, weight
    vscale v8, v8, s12, weight
    vscale v9, v9, s12, weight
    vadd  v6, v6, v7
    vadd  v8, v8, v9
    vadd  v6, v6, v8
    isub  s14, s14, s13
    stv   v6, (s14)
    movi  s12, 1
    .holds s12
    ret   link_node
interpolate_apart:
    mov   s12, s0
    ret   link_node
.endfunc
