; Follows the ray from its first packet to the nearest hit, or with any_hit = 1 to any hit nearer than near_t. Report, pseudo codes 2 and 3.
; In: origin, direction, the first packet (packet_count < 0: none) and the walk's notes, near_t, near = 0, any_hit.
; Out: near (0: nothing), near_t; near_slot where any_hit = 0. Returns by link_trace. Scratch: nearest, gathered, place, stride, left, s12 to
; s15, v6 to v8, w0 to w2.
;
; Packets and the walk between them are one loop, which stands here once for each of the rows that meet a packet. A packet comes in one
; transfer; from other layouts than `packet` triangle by triangle, and one that is too large for the buffer piece by piece.

; Meets the \count triangles of the packet in the buffer. On to \over with any hit, where that ends the search.
.macro meet_packet any, count, over
    movi  s13, PACKET
  .if \any
    rany  nearest, origin, s13, \count, dir + t - pos
    vget  near, nearest, 1
    bnez  near, \over
  .else
    rnear nearest, origin, s13, \count, dir + t - pos
  .endif
.endm

; As many of the triangles that are left as the buffer holds.
.macro next_piece
    movi  gathered, PACKET_AT_ONCE
    blt   gathered, left, piece_\@
    mov   gathered, left
piece_\@:
    isub  left, left, gathered
.endm

; A packet of the layout `packet` in pieces: each is gathered from the ten arrays of the packet.
.macro meet_large_packet any, over
    mov   left, packet_count
    mov   place, packet_refs
    slli  stride, packet_count, 2
large_\@:
    next_piece
    slli  s12, gathered, 2
    movi  s13, PACKET
    mov   s14, place
    .rept PACKET_OCTETS / 4
    load  s13, s14, s12
    addr  s13, s13, s12
    addr  s14, s14, stride
    .endr
    addr  place, place, s12
    meet_packet \any, gathered, \over
    bgtz  left, large_\@
.endm

; A packet of another layout: each triangle's words are put where they belong.
.macro meet_references any, over
    mov   left, packet_count
references_\@:
    next_piece
    movi  place, PACKET
    slli  stride, gathered, 2
    addr  packet_count, place, stride       ; the end of the names
  .if !SKIP_EMPTY
    beq   place, packet_count, references_end_\@
  .endif
    begin_references gathered
reference_\@:
    next_reference
    sw    s15, (place)
  .if LAYOUT_REPORT
    fetch_whole_triangle slot, s15
    load_triangle slot
  .else
    fetch_vertices v6, s15
  .endif
    addr  s14, place, stride
    .irp  vertex, v6, v7, v8
    .rept 3, k
    vget  s12, \vertex, k
    sw    s12, (s14)
    addr  s14, s14, stride
    .endr
    .endr
    lea   place, 4(place)
    bltu  place, packet_count, reference_\@
    meet_packet \any, gathered, \over
    bgtz  left, references_\@
references_end_\@:
.endm

; The search, for any hit or for the nearest one.
.macro search any
search_packet_\any:
  .if SKIP_EMPTY
    blez  packet_count, search_next_\any
  .endif
  .if LAYOUT_PACKET
    .if LARGEST_PACKET > PACKET_AT_ONCE
    movi  s12, PACKET_AT_ONCE
    blt   s12, packet_count, search_large_\any
    .endif
    element s14, s0, packet_count, PACKET_OCTETS
    movi  s13, PACKET
    load  s13, packet_refs, s14
    meet_packet \any, packet_count, search_over
  .else
    meet_references \any, search_over
  .endif
search_next_\any:
    lwide came_by, NOTES + note.plane(last_note)
  .if SKIP_BEYOND
    .if !\any
    vget  near_t, nearest, 0
    .endif
    rbefore s12, origin, came_by, near_t, dir + t - pos
    bnez  s12, search_over
  .endif
    beqz  last_note, search_begin_\any
    lw    packet_refs, NOTES + note.far(last_note)
    lea   last_note, -sizeof(note)(last_note)
search_walk_\any:
  .if LAYOUT_REPORT
    lwide leaves_by, NOTES + note.plane(last_note)
    call  link_step, descend
  .else
    walk_down
  .endif
    jump  search_packet_\any
  .if LAYOUT_PACKET && LARGEST_PACKET > PACKET_AT_ONCE
search_large_\any:
    meet_large_packet \any, search_over
    jump  search_next_\any
  .endif
search_begin_\any:
    begin_walk search_over
  .if SKIP_BEYOND
    rbefore s12, origin, came_by, near_t, dir + t - pos
    beqz  s12, search_walk_\any
    jump  search_over
  .else
    jump  search_walk_\any
  .endif
.endm

.func trace
    walk_names
    .holds gathered
    .holds place
    .holds stride
    .holds left
    .holds v6, pos
    .holds v7, pos
    .holds v8, pos
    bltz  packet_count, trace_end
    vput  nearest, near_t, 0
    vput  nearest, s0, 1
.if SKIP_ANY_HIT
    beqz  any_hit, search_packet_0
    search 1
.endif
    search 0
search_over:
    vget  near, nearest, 1
    beqz  near, trace_end
    vget  near_t, nearest, 0
    bnez  any_hit, trace_end
    fetch_whole_triangle near_slot, near
trace_end:
    ret   link_trace
.endfunc
