        .ifndef lights
        .error "how many lights?" ; error E028: how many lights?
        .endif
        .warning "no shadows"   ; warning W001: no shadows
        .struct node
        .field plane, 54
        .endstruct
        .assert sizeof(node) == 55, "a node has 55 octets" ; error E029: a node has 55 octets
