; Brings the triangles of the packet to the buffer, up to 512 at once, and then tests them (report 6.2); a packet of more comes in pieces.
; Each is tested as in the profile `report`, and the first of equal hits stays.
; In: packet_count, packet_refs, near, near_t. Out: near, near_t, near_slot. Returns by link_packet.
; Scratch: s12 to s15, piece_end and what triangle needs; packet_count and packet_refs are used up.
;
; Each triangle is kept with its name, which is its address: in the report's layout in place of the smallest coordinates, which no kernel
; reads, so that it takes 31 octets as there; in other layouts behind it.
.reg piece_end, s11          ; the end of the triangles of a piece

.if LAYOUT_REPORT
.equ NAME_AT, triangle.small
.equ KEPT_OCTETS, sizeof(triangle)
.else
.equ NAME_AT, sizeof(triangle)
.equ KEPT_OCTETS, sizeof(triangle) + 4
.endif
.equ PIECE, PIECE_OCTETS / KEPT_OCTETS

.buffer
TRIANGLES: .space PIECE * KEPT_OCTETS
.text

.func packet
    .holds piece_end
packet_piece:
    movi  slot, TRIANGLES
    movi  s14, PIECE
    blt   s14, packet_count, 1f         ; not min, which is of words: a count may not fit one
    mov   s14, packet_count
1:  isub  packet_count, packet_count, s14
    element piece_end, slot, s14, KEPT_OCTETS
    beq   slot, piece_end, packet_end
2:  next_reference
    movi  s12, sizeof(triangle)
    load  slot, s15, s12
    sw    s15, NAME_AT(slot)
    lea   slot, KEPT_OCTETS(slot)
    bltu  slot, piece_end, 2b
    movi  slot, TRIANGLES
    mov   s15, s0                       ; the nearest triangle of the piece
3:  call  link_step, triangle
    .holds s12, t
    bge   s12, near_t, 4f
    mov   near_t, s12
    mov   s15, slot
4:  lea   slot, KEPT_OCTETS(slot)
    bltu  slot, piece_end, 3b
    beqz  s15, 5f
    lw    near, NAME_AT(s15)
    keep_nearest s15
5:  bgtz  packet_count, packet_piece
packet_end:
    ret   link_packet
.endfunc
