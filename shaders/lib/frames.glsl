// Orthonormal frames. Local z is the normal.

// The branchless frame of Duff et al. 2017, "Building an Orthonormal Basis, Revisited". Columns: tangent, bitangent, n.
mat3 frame_around(vec3 n) {
    float s = n.z >= 0.0 ? 1.0 : -1.0;
    float a = -1.0 / (s + n.z);
    float b = n.x * n.y * a;
    return mat3(vec3(1.0 + s * n.x * n.x * a, s * b, -s * n.x), vec3(b, s + n.y * n.y * a, -n.y), n);
}

// The frame around n whose first axis is the part of `tangent` orthogonal to n (any axis where there is none).
mat3 frame_along(vec3 n, vec3 tangent, float handedness) {
    vec3 t = tangent - n * dot(n, tangent);
    float l = dot(t, t);
    if (!(l > 1e-12)) return frame_around(n);
    t *= inversesqrt(l);
    return mat3(t, cross(n, t) * handedness, n);
}

// The axes of a node whatever its scale: its z, the part of its x orthogonal to that, and across both, on the side of its y.
mat3 node_frame(mat4x3 world_from_local) {
    vec3 x = normalize(world_from_local[0]), z = normalize(world_from_local[2]);
    return frame_along(z, x, dot(cross(z, x), world_from_local[1]) < 0.0 ? -1.0 : 1.0);
}
