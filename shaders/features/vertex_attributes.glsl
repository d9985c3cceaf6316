// Normals, tangents, texture coordinates and colours at the vertices of triangles.
#if HAS_VERTEX_ATTRIBUTES || HAS_EMISSION_MAPS
// Barycentric coordinates of a point on the triangle.
vec3 triangle_weights(Triangle r, vec3 position) {
    vec3 e1 = r.v1 - r.v0, e2 = r.v2 - r.v0, d = position - r.v0;
    vec3 n = cross(e1, e2);
    float inverse = 1.0 / dot(n, n);
    float b1 = dot(cross(d, e2), n) * inverse, b2 = dot(cross(e1, d), n) * inverse;
    return vec3(1.0 - b1 - b2, b1, b2);
}
#endif

#if HAS_VERTEX_ATTRIBUTES
struct Vertex {
    vec3 normal;   // unit; zero = take the geometric one
    uint color;    // four 8-bit fractions, linear
    vec4 tangent;  // unit, w = ±1; zero = derive it from uv0
    vec2 uv0, uv1;
};
layout(scalar) readonly buffer Vertices { Vertex vertices[]; };
layout(scalar) readonly buffer TriangleIndices { uvec3 triangle_indices[]; };

// Direction of increasing u over the triangle; zero where uv0 does not span it.
vec3 tangent_from_uv(Triangle r, vec2 uv_0, vec2 uv_1, vec2 uv_2, out float handedness) {
    vec2 d1 = uv_1 - uv_0, d2 = uv_2 - uv_0;
    float det = d1.x * d2.y - d1.y * d2.x;
    // The bitangent runs along decreasing v: image rows count downward.
    handedness = det < 0.0 ? 1.0 : -1.0;
    return (d2.y * (r.v1 - r.v0) - d1.y * (r.v2 - r.v0)) * sign(det);
}

// At barycentric coordinates; `shading`: the normal, in the triangle's frame, not unit.
void interpolate_attributes(inout SurfacePoint s, Triangle r, vec2 uv, inout vec3 shading) {
    uvec3 indices = triangle_indices[attributes_index(r.attributes)];
    Vertex a = vertices[indices.x], b = vertices[indices.y], c = vertices[indices.z];
    vec3 weights = vec3(1.0 - uv.x - uv.y, uv);
    shading = mat3(a.normal, b.normal, c.normal) * weights;
    s.uv0 = mat3x2(a.uv0, b.uv0, c.uv0) * weights;
    s.uv1 = mat3x2(a.uv1, b.uv1, c.uv1) * weights;
    s.color = mat3x4(unpackUnorm4x8(a.color), unpackUnorm4x8(b.color), unpackUnorm4x8(c.color)) * weights;
    float handedness;
    vec3 derived = tangent_from_uv(r, a.uv0, b.uv0, c.uv0, handedness);
    bool stored = a.tangent.w != 0.0;
    vec4 tangent = stored ? vec4(mat3(a.tangent.xyz, b.tangent.xyz, c.tangent.xyz) * weights, a.tangent.w)
                          : vec4(derived, handedness);
    if (dot(tangent.xyz, tangent.xyz) > 0.0) s.tangent = tangent;
}

// Texture coordinates of a point on the triangle.
void triangle_uv(Triangle r, vec3 position, inout vec2 uv0, inout vec2 uv1) {
    vec3 weights = triangle_weights(r, position);
    uvec3 indices = triangle_indices[attributes_index(r.attributes)];
    Vertex a = vertices[indices.x], b = vertices[indices.y], c = vertices[indices.z];
    uv0 = mat3x2(a.uv0, b.uv0, c.uv0) * weights;
    uv1 = mat3x2(a.uv1, b.uv1, c.uv1) * weights;
}

vec4 triangle_color(Triangle r, vec3 position) {
    uvec3 i = triangle_indices[attributes_index(r.attributes)];
    return mat3x4(unpackUnorm4x8(vertices[i.x].color), unpackUnorm4x8(vertices[i.y].color), unpackUnorm4x8(vertices[i.z].color)) *
           triangle_weights(r, position);
}
#else
#define interpolate_attributes(s, r, uv, shading)
#define triangle_uv(r, position, uv0, uv1)
#define triangle_color(r, position) vec4(1)
#endif
