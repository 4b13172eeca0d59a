; Driver for the packet: 40 triangles, all tested, each a little nearer than the one before.
.entry driver
.equ TRIANGLES_AT, 65536
.equ REFERENCES_AT, 1024
.func driver
    movi  s20, 40
    li    s21, TRIANGLES_AT
    movi  s22, REFERENCES_AT
    li    s23, 0.03125:pos
    movi  s13, sizeof(triangle)
    movi  s14, PATTERN
1:  store s21, s14, s13
    stw   s21, (s22)
    lea   s22, sizeof(reference)(s22)
    addr  s21, s21, s13
  .rept 3, k
    lw    s12, PATTERN + 12 * k + 8(s0)
    iadd  s12, s12, s23
    sw    s12, PATTERN + 12 * k + 8(s0)
  .endr
    isubi s20, s20, 1
    bnez  s20, 1b

    lv    origin, ABOVE(s0)
    lv    direction, DOWN(s0)
    movi  slot, SLOT
    movi  near_slot, NEAR_SLOT
    li    near_t, NEVER
    mov   near, s0
    mov   any_hit, s0
    movi  packet_count, 40
    movi  packet_refs, REFERENCES_AT
    call  link_packet, packet
    halt
.endfunc
.buffer
DOWN:    .fixed dir, 0, 0, -1
ABOVE:   .fixed pos, 0, 0, 3
PATTERN: .fixed pos, -1, -1, 0, 1, -1, 0, 0, 1, 0
         .half 0
REFERENCES: .space 512
SLOT: .space sizeof(triangle)
NEAR_SLOT: .space sizeof(triangle)
.text
