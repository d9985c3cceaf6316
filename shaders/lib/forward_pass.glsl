// What forward rays need to know of the pass that they belong to, and backward ones that meet them. Twin: struct ForwardPass of
// host/render/forward_rays.h.
struct ForwardPass {
    uint pass;
    uint seed;
    uint count;           // forward paths
    float merge_scale;    // radius of merging, in widths of what a pixel covers there
    float short_scale;    // edges below it are short, in the same widths
    float path_flux;      // power of all lights / count, lm
    float inverse_power;  // 1 / power of all lights
    float splat_unit;     // cd/m², about the mean radiance of the scene
};
layout(scalar, set = 0) readonly buffer ForwardPassTable { ForwardPass forward_pass; };
