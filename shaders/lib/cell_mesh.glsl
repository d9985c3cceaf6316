// The triangles that stand in every cell of a microstructure, around the cell's middle, in a hierarchy that all cells share; made by
// host/scene/cell_mesh. It is a list in which boxes stand before what they hold, and say what stands behind that, so that a walk needs
// no stack.
#include "lib/constants.glsl"
#include "geometry/triangle.glsl"

// Twin in host/scene/cell_mesh.h.
struct CellMesh {
    uint nodes;  // 0 = none
    uint first_node, first_triangle;
    float low, high;  // m, along z
};

// Twins in host/scene/cell_mesh.h.
struct CellNode {
    vec3 lo;
    uint behind;  // node that follows all that this one holds
    vec3 hi;
    uint leaf;    // 0, or count:3 | first triangle:29
};
struct CellTriangle {
    vec3 v0, v1, v2;  // m
};
layout(scalar, set = 0) readonly buffer CellNodes { CellNode cell_nodes[]; };
layout(scalar, set = 0) readonly buffer CellTriangles { CellTriangle cell_triangles[]; };

vec3 cell_normal(CellTriangle c) { return triangle_normal(Triangle(c.v0, 0u, c.v1, 0u, c.v2, 0u)); }

// Nearest hit with 0 < t < t_max: t and the number of the triangle. Boxes are wider than their triangles by what is rounded here.
bool cell_mesh_meet(CellMesh m, vec3 origin, vec3 direction, float t_max, out float t, out uint triangle) {
    t = t_max, triangle = NO_RECORD;
    vec3 inverse = 1.0 / mix(direction, vec3(1e-30), lessThan(abs(direction), vec3(1e-30)));
    RayShear shear = ray_shear(direction);
    uint i = 0u;
    while (i < m.nodes) {
        CellNode node = cell_nodes[m.first_node + i];
        vec3 a = (node.lo - origin) * inverse, b = (node.hi - origin) * inverse, near = min(a, b), far = max(a, b);
        float enter = max(max(near.x, near.y), max(near.z, 0.0)), leave = min(min(far.x, far.y), min(far.z, t));
        bool met = enter <= leave;
        uint count = met ? node.leaf & 7u : 0u;
        for (uint k = 0u; k < count; ++k) {
            uint number = (node.leaf >> 3) + k;
            CellTriangle c = cell_triangles[m.first_triangle + number];
            GeometryHit hit;
            if (triangle_meet(shear, origin, direction, c.v0, c.v1, c.v2, t, hit)) t = hit.t, triangle = number;
        }
        i = met ? i + 1u : node.behind;
    }
    return triangle != NO_RECORD;
}
