; Follows the ray from its first packet to the nearest hit, or with any_hit = 1 to any hit nearer than near_t. Report, pseudo code 3, with
; two buffers for triangles: while the last triangle of the packet in one is tested, the packet behind begins to come to the other. Only a
; search that the last triangle itself ends fetches for nothing: the packet behind is looked for when all others have been tested.
; In: origin, direction, the first packet and its box (packet_count < 0: none), near_t, near = 0, any_hit.
; Out: near (0: nothing), near_t, near_slot. Returns by link_trace. Scratch: what packet and next_packet need, slot, name, fills, left.

.reg name,     s25        ; the address in global memory of the triangle at slot
.reg fills,    s9         ; where the next triangle goes; not across next_packet, as left and the two below
.reg coming,   s13        ; the address in global memory of the triangle that was asked for last
.reg comes_to, s14        ; its place in the buffer

; Triangles of a buffer: no more than the scene's largest packet has, so that most scenes find room for two in the report's one.
.equ HALF, max(1, min(PIECE_OCTETS / sizeof(triangle), LARGEST_PACKET))
.equ HALF_OCTETS, HALF * sizeof(triangle)

.buffer
TRIANGLES: .space 2 * HALF_OCTETS
.text

; Begins the load of the packet's next triangle, to fills. Its reference is read into registers, which waits for the load before: the
; triangle at slot is there. Out: coming, comes_to, fills, left. Scratch: s12, w0.
.macro begin_triangle
  .if LAYOUT_REPORT
    ldwide w0, reference.triangle(packet_refs)
    wlow  coming, w0
    whigh packet_refs, w0
  .else
    ldw   coming, reference.triangle(packet_refs)
    lea   packet_refs, sizeof(reference)(packet_refs)
  .endif
    movi  s12, sizeof(triangle)
    load  fills, coming, s12
    mov   comes_to, fills
    lea   fills, sizeof(triangle)(fills)
    isubi left, left, 1
  .if LARGEST_PACKET > HALF
    li    s12, TRIANGLES + HALF_OCTETS      ; a packet of more goes round: what was there has been tested
    beq   fills, s12, around_\@
    li    s12, TRIANGLES + 2 * HALF_OCTETS
    bne   fills, s12, inside_\@
around_\@:
    lea   fills, -HALF_OCTETS(fills)
inside_\@:
  .endif
.endm

; Tests the triangle at slot, which is there. The first of equal hits stays.
.macro test_triangle
    call  link_step, triangle
    .holds s12, t
    bge   s12, near_t, farther_\@
    mov   near_t, s12
    mov   near, name
    keep_nearest slot
farther_\@:
.endm

.func trace
    .holds near_t, t
    .holds exit_t, t
    .holds name
    .holds fills
    .holds left
    .holds coming
    .holds comes_to
    li    steps, MOST_STEPS
    bltz  packet_count, trace_end
trace_start:
    mov   left, packet_count
    movi  fills, TRIANGLES
    blez  left, trace_empty
    begin_triangle
trace_packet:
    mov   slot, comes_to
    mov   name, coming
    call  link_packet, packet
    call  link_packet, next_packet
    movi  fills, TRIANGLES
    li    s12, TRIANGLES + HALF_OCTETS
    bleu  s12, slot, 1f
    mov   fills, s12
1:  mov   left, packet_count
    blez  left, 2f
    begin_triangle
    jump  3f
2:  wait_for_load
3:  test_triangle
    bltz  packet_count, trace_end
.if SKIP_ANY_HIT
    beqz  any_hit, 4f
    bnez  near, trace_end
4:
.endif
.if SKIP_BEYOND
    bnez  any_hit, 5f
    beqz  near, 6f
5:  blt   near_t, exit_t, trace_end
6:
.endif
    bgtz  packet_count, trace_packet
trace_empty:
    call  link_packet, next_packet
    bgez  packet_count, trace_start
trace_end:
    ret   link_trace
.endfunc
