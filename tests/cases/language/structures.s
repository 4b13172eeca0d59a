; Offsets and sizes down to odd octets.
        .struct node
        .field kind, 1
        .field box, 2, 6
        .field next, 3
        .endstruct
        movi s1, sizeof(node)   ; s1 = 16
        movi s2, node.next      ; s2 = 13
        lbu  s3, root + node.next(s0) ; s3 = 9
        halt
        .buffer
        .byte 0
root:   .space node.next
        .byte 9
