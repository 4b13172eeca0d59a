; Tests every triangle of the packet, a block of references with one instruction. The nearest hit has the smallest t, then the lowest
; index. In: packet_count, packet_refs, near, near_t, any_hit. Out: near, near_t, near_slot. Returns by link_packet. Layout: wide.
; Scratch: s12 to s15, v6; packet_count and packet_refs are used up.
.func packet
    blez  packet_count, packet_end
    mov   s15, near
packet_block:
    movi  s12, REFERENCES_AT_ONCE
    blt   s12, packet_count, 1f
    mov   s12, packet_count
1:  isub  packet_count, packet_count, s12
    slli  s14, s12, 2
    movi  s13, REFERENCES
    load  s13, packet_refs, s14
    addr  packet_refs, packet_refs, s14
    addr  s14, s13, s14
    vput  v6, s13, 0
    vput  v6, s14, 1
    rpacket near_t, near, origin, v6, dir + t - pos
    bgtz  packet_count, packet_block
    beq   near, s15, packet_end
    bnez  any_hit, packet_end
    movi  s12, sizeof(triangle)
    load  near_slot, near, s12
packet_end:
    ret   link_packet
.endfunc
