// Instances: entries of the hierarchy whose own trees are walked in their own frames (lib/hierarchy_walk.glsl).
#if HAS_INSTANCES
// If the primitive is an instance, of which it was the `last` of its leaf.
void enter_instance(inout Traversal w, Triangle primitive, uint index, bool last) {
    if (!is_instance(primitive.attributes)) return;
    uint header = floatBitsToUint(primitive.v0.x);
    mat4x3 m = transform_at(floatBitsToUint(primitive.v0.y)).local_from_world;
    if (!last) traversal_stack[w.height++] = w.node;
    else w.height++;  // what was popped still lies there
    traversal_stack[w.height++] = BVH_RETURN;
    traversal_enter(w, header, m * vec4(w.world_origin, 1.0), m * vec4(w.world_direction, 0.0));
    w.instance = index;
    w.node = nodes[header].w;
}

void leave_instance(inout Traversal w) {
    if (w.node != BVH_RETURN) return;
    w.instance = NO_RECORD;
    traversal_enter(w, tree_header(), w.world_origin, w.world_direction);
    w.height--;
    w.node = traversal_stack[w.height];
}
#else
#define enter_instance(w, primitive, index, last)
#define leave_instance(w)
#endif
