; Walks the tree of a pixel's rays depth first: reflected child, refracted child, back to the parent. A node is a ray that has met a
; surface, as in table 2; it is released when the walk leaves it, so that two a level are enough. Report 5.4, pseudo code 5.
; In: the camera ray and its first packet. Out: pixel_colour. Returns by link_tree.

.struct treenode
    .field parent, 4        ; address in the buffer, 0 for the root
    .field left, 4          ; the reflected child
    .field right, 4         ; the refracted child
    .field visited, 1       ; 1 while the refracted child is still to come
    .field type, 1          ; 0 camera ray, 1 reflected (totally, too), 2 refracted
    .field level, 1
    .field state, 1         ; 1 inside a body, 0 in the void
    .field origin, 12       ; the ray
    .field direction, 12
    .field weight, 4        ; of the path
    .field near, 4          ; the triangle that it met
    .field near_t, 4        ; and how far away
.endstruct

.buffer
TREE: .space (2 * BOUNCES + 1) * sizeof(treenode)
.text

; The ray of the node and its hit with the material, which its shadow rays and its other child have overwritten. Scratch: s12 to s14.
.macro recall
    lv    origin, treenode.origin(node)
    lv    direction, treenode.direction(node)
    lbu   inside, treenode.state(node)
    lw    near_t, treenode.near_t(node)
    .holds s13
    lw    s13, treenode.near(node)
    movi  s12, sizeof(triangle)
    load  near_slot, s13, s12
    wait_for_load
    load_material
.endm

; Makes the child \at (not s12, s13) of the node: the ray, its type, its state and a level more. Scratch: s12.
.macro make_child at, type
    sw    node, treenode.parent(\at)
    movi  s12, \type
    sb    s12, treenode.type(\at)
    lbu   s12, treenode.level(node)
    iaddi s12, s12, 1
    sb    s12, treenode.level(\at)
    sb    inside, treenode.state(\at)
    sv    origin, treenode.origin(\at)
    sv    direction, treenode.direction(\at)
.endm

; Goes to the child \at when its ray meets a surface, by the search \meets; else it sees the background.
.macro follow at, meets
    mov   node, \at
    call  link_node, \meets
    bnez  near, tree_visit
  .if HAS_BACKGROUND
    lw    weight_now, treenode.weight(node)
    call  link_node, contribution
  .endif
    lw    node, treenode.parent(node)
.endm

.func ray_tree
    movi  node, TREE
    sw    s0, treenode.parent(node)
    sb    s0, treenode.type(node)
    sb    s0, treenode.level(node)
    sb    s0, treenode.state(node)
    li    weight_now, 1:weight
    sw    weight_now, treenode.weight(node)
    sv    origin, treenode.origin(node)
    sv    direction, treenode.direction(node)
    seek_nearest
    call  link_trace, trace
    bnez  near, tree_visit
.if HAS_BACKGROUND
    call  link_node, contribution
.endif
    ret   link_tree
tree_visit:
    sw    near, treenode.near(node)
    sw    near_t, treenode.near_t(node)
    lw    weight_now, treenode.weight(node)
    call  link_node, contribution
.region generation
    ; The next node of the walk: the reflected child, the refracted child, or one of those that wait above.
    lbu   s12, treenode.level(node)
    movi  s13, BOUNCES
    beq   s12, s13, tree_leave
    movi  s13, TREE
    element s13, s13, s12, 2 * sizeof(treenode)
    lea   s12, sizeof(treenode)(s13)
    sw    s12, treenode.left(node)
    lea   s12, 2 * sizeof(treenode)(s13)
    sw    s12, treenode.right(node)
    mov   weight_now, s0                ; what total reflection adds to the reflected ray
.if HAS_GLASS
    recall
    lw    s12, MATERIAL_AT(s0)
    lw    s13, material.transmission(s12)
    .holds s13, weight
    beqz  s13, tree_opaque
    lw    s12, treenode.weight(node)
    .holds s12, weight
    mul   s13, s12, s13, weight
    lw    s14, treenode.right(node)
    .holds s14
    sw    s13, treenode.weight(s14)
    call  link_node, refract
    lw    s14, treenode.right(node)
    bltz  s12, tree_total
    movi  s13, 1
    xor   inside, inside, s13
    make_child s14, 2
    lw    s12, treenode.weight(s14)
    li    s13, CUTOFF
    ble   s12, s13, tree_opaque
    movi  s13, 1
    sb    s13, treenode.visited(node)
    jump  tree_mirror
tree_total:
    lw    weight_now, treenode.weight(s14)
tree_opaque:
    sb    s0, treenode.visited(node)
tree_mirror:
.endif
    recall
    .holds s12
    lw    s12, MATERIAL_AT(s0)
    lw    s12, material.reflection(s12)
    .holds s12, weight
    lw    s13, treenode.weight(node)
    .holds s13, weight
    mul   s12, s12, s13, weight
    add   s12, weight_now, s12
    lw    s14, treenode.left(node)
    sw    s12, treenode.weight(s14)
    li    s13, CUTOFF
    .holds s13, weight
    ble   s12, s13, tree_right
    call  link_node, reflect
    lw    s14, treenode.left(node)
    make_child s14, 1
    follow s14, reflects
tree_right:
    .holds s12
    .holds s13
.if HAS_GLASS
    lbu   s12, treenode.visited(node)
    beqz  s12, tree_leave
    sb    s0, treenode.visited(node)
    lw    s14, treenode.right(node)
    follow s14, refracts
.endif
tree_leave:
.if HAS_GLASS
    lw    node, treenode.parent(node)
    bnez  node, tree_right
.endif
    ret   link_tree
.endregion
.endfunc
