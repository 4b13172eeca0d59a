; The reflected ray, R = D + 2 c N with c = -N . D, from the point. Report 4.1. In: point, facing, incident, cosine.
; Out: origin, direction and the first packet. Returns by link_node. Scratch: v6 and what own_packet needs.
.func reflect
    vscale v6, facing, cosine, dir
    .holds v6, dir
    vadd  direction, incident, v6
    vadd  direction, direction, v6          ; in two steps: 2 c may be 2, which a direction cannot hold
    vmov  origin, point
    call  link_packet, own_packet
    ret   link_node
.endfunc
