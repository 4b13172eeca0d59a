; Walks the tree of a pixel's rays depth first: reflected child, refracted child, back to the parent. A node is released when the walk
; leaves it, so one record a level is enough. Report 5.4, table 2. In: the camera ray and its first packet. Out: pixel_colour.
; Returns by link_tree.
.func ray_tree
    .holds refracted_weight, weight
    movi  node, NODES
    mov   level, s0
    mov   inside, s0
    li    weight_now, 1:weight
tree_visit:
    call  link_node, contribution
    beqz  near, tree_leave
    movi  s12, BOUNCES
    beq   level, s12, tree_leave
.if HAS_GLASS
    call  link_node, refracts
.else
    mov   reflected_weight, s0
.endif
    call  link_node, reflects
.if HAS_GLASS
    li    s12, CUTOFF
    .holds s12, weight
    ble   refracted_weight, s12, tree_reflected
    ; What the refracted ray will need when the walk is back.
    sw    refracted_weight, raynode.weight(node)
    sw    inside, raynode.inside(node)
    sw    cosine, raynode.cosine(node)
    sv    facing, raynode.normal(node)
    sv    incident, raynode.incident(node)
    sv    behind, raynode.behind(node)
    ble   reflected_weight, s12, tree_refracted
    movi  s13, 1
    sb    s13, raynode.visited(node)
    jump  tree_reflect
tree_reflected:
    sb    s0, raynode.visited(node)
    ble   reflected_weight, s12, tree_leave
tree_reflect:
.else
    li    s12, CUTOFF
    ble   reflected_weight, s12, tree_leave
.endif
    mov   weight_now, reflected_weight
    call  link_node, reflect
    iaddi level, level, 1
    lea   node, sizeof(raynode)(node)
    jump  tree_visit
tree_leave:
.if HAS_GLASS
    beqz  level, tree_done
    isubi level, level, 1
    lea   node, -sizeof(raynode)(node)
    lbu   s12, raynode.visited(node)
    .holds s12
    beqz  s12, tree_leave
tree_refracted:
    sb    s0, raynode.visited(node)
    lw    weight_now, raynode.weight(node)
    call  link_node, refract
    iaddi level, level, 1
    lea   node, sizeof(raynode)(node)
    jump  tree_visit
.endif
tree_done:
    ret   link_tree
.endfunc
