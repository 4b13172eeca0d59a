        .macro need what
        .ifndef \what
        .error "a symbol is missing"
        .endif
        .endm
        need camera
        .warning "built without shadows"
        .struct node
        .field a, 54
        .endstruct
        .assert sizeof(node) == 55, "a node has 55 octets"
        .assert end == 0
end:
