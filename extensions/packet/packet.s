; Tests every triangle of the packet. The nearest hit has the smallest t, then the lowest index.
; In: packet_count, packet_refs, near, near_t, any_hit. Out: near, near_t, near_slot. Returns by link_packet.
;
; The test is part of the loop: a triangle's vertices go from global memory to registers, its other octets are read with a hit that is
; the nearest so far (of the report's layout it goes to the buffer whole, beside the nearest one).
; Scratch: s12 to s15, tested, v6 to v9; packet_count and packet_refs are used up.

; On to the next triangle when the ray has met this one, s15.
.macro pass_tested
  .if SKIP_TESTED
    tested_place s12, s15
    lw    tested, TESTED(s12)
    beq   tested, s15, packet_rest
    sw    s15, TESTED(s12)
  .endif
.endm

.func packet
    .holds v6, pos
    .holds v7, pos
    .holds v8, pos
.if SKIP_EMPTY
    blez  packet_count, packet_end
.endif
.if LAYOUT_REPORT
    mov   s14, packet_count
  .if !SKIP_EMPTY
    beqz  s14, packet_end
  .endif
packet_next:
    next_reference
    pass_tested
    fetch_triangle slot, s15
    load_triangle slot
.else
  .if LARGEST_PACKET > REFERENCES_AT_ONCE
packet_block:
    movi  s12, REFERENCES_AT_ONCE
    blt   s12, packet_count, 1f
    mov   s12, packet_count
1:  isub  packet_count, packet_count, s12
    fetch_references s14, s12
    pass_references s14
  .else
    fetch_references s14, packet_count
  .endif
    addr  s14, s13, s14
  .if !SKIP_EMPTY
    beq   s13, s14, packet_end
  .endif
;-packet_next:
;-    lwp   s15, 4(s13)
;-    find_triangle s15
;-    pass_tested
;-    fetch_vertices v6, s15
;-.endif
    .assert !LAYOUT_PACKED, "rpacket reads structures in words: take the layout `wide`" ;+
    vput  v6, s13, 0 ;+
    vput  v6, s14, 1 ;+
  .if SKIP_TESTED ;+
    li    s12, 2 * TESTED ;+
    or    s12, s12, any_hit ;+
    vput  v6, s12, 2 ;+
  .else ;+
    vput  v6, any_hit, 2 ;+
  .endif ;+
    mov   s15, near ;+
    rpacket near_t, near, origin, v6, dir + t - pos ;+
    beq   near, s15, packet_rest ;+
    triangle_octets s12 ;+
    load  near_slot, near, s12 ;+
  .if SKIP_ANY_HIT ;+
    bnez  any_hit, packet_end ;+
  .endif ;+
.endif ;+
.if LAYOUT_REPORT ;+
.region triangle
    rtri  s12, v9, origin, v6, dir + t - pos
    .holds s12, t
.endregion
    bge   near_t, s12, packet_nearer
.endif ;+
packet_rest:
.if LAYOUT_REPORT
    isubi s14, s14, 1
    bnez  s14, packet_next
.else
;-    bltu  s13, s14, packet_next
  .if LARGEST_PACKET > REFERENCES_AT_ONCE
    bgtz  packet_count, packet_block
  .endif
.endif
packet_end:
    ret   link_packet
.if LAYOUT_REPORT ;+
packet_nearer:
    .holds s12, t
    bne   near_t, s12, 1f
    bgeu  s15, near, packet_rest
1:  mov   near_t, s12
    mov   near, s15
.if SKIP_ANY_HIT
    bnez  any_hit, packet_end
.endif
.if LAYOUT_REPORT
    mov   s12, slot
    mov   slot, near_slot
    mov   near_slot, s12
;-.elseif SKIP_OCTETS || LAYOUT_PACKED
;-    sv    v6, triangle.v0(near_slot)
;-    sv    v7, triangle.v1(near_slot)
;-    sv    v8, triangle.v2(near_slot)
;-.else
;-    fetch_whole_triangle near_slot, s15
.endif
    jump  packet_rest
.endif ;+
.endfunc
