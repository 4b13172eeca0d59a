; Tests every triangle of the packet. The nearest hit has the smallest t, then the lowest index.
; In: packet_count, packet_refs, near, near_t, any_hit. Out: near, near_t, near_slot. Returns by link_packet.
; A triangle at a time is loaded beside the nearest one, so any packet fits the buffer; references that are an array come in blocks.
; Scratch: s12 to s15 and what triangle needs; packet_count and packet_refs are used up.
.func packet
.if SKIP_EMPTY
    blez  packet_count, 4f
.endif
.if LAYOUT_REPORT
    mov   s14, packet_count
  .if !SKIP_EMPTY
    beqz  s14, 4f
  .endif
2:  next_reference
.else
packet_block:
    movi  s12, REFERENCES_AT_ONCE
    blt   s12, packet_count, 1f             ; not min, which is of words: a count may not fit one
    mov   s12, packet_count
1:  isub  packet_count, packet_count, s12
    fetch_references s12, s12
    addr  s14, s13, s12
    pass_references s12
  .if !SKIP_EMPTY
    beq   s13, s14, 4f
  .endif
2:  lwp   s15, 4(s13)
    find_triangle s15
.endif
.if SKIP_TESTED
    tested_place s12, s15
    lw    tested, TESTED(s12)
    beq   tested, s15, 3f
    sw    s15, TESTED(s12)
.endif
    fetch_triangle slot, s15
    call  link_step, triangle
    .holds s12, t
    blt   near_t, s12, 3f
    bne   near_t, s12, packet_nearer
    bltu  s15, near, packet_nearer
.if LAYOUT_REPORT
3:  isubi s14, s14, 1
    bnez  s14, 2b
.else
3:  bltu  s13, s14, 2b
    bgtz  packet_count, packet_block
.endif
4:  ret   link_packet
packet_nearer:
    .holds s12, t
    mov   near_t, s12
    mov   near, s15
    mov   s12, slot
    .holds s12
    mov   slot, near_slot
    mov   near_slot, s12
.if SKIP_ANY_HIT
    beqz  any_hit, 3b
    ret   link_packet
.else
    jump  3b
.endif
.endfunc
