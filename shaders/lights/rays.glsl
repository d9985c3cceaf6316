// Rays of a file, as makers publish their lamps and as other programs trace them: TM-25, Zemax, LightTools, Speos (scenes/FORMAT.md).
// They start where the file says, in the frame of the node, in millimetres; of its transform only position and directions count. Each
// is drawn as often as its part of the flux. A ray of one wavelength shines in a band around it, 5 nm wide at half its height.
//
// Nothing meets such a ray but what it runs into: forward rays alone bring its light, so backward ones alone see none.
//
// Example:
//     {"nodes": [{"name": "LED", "translation": [0, 1.2, 0.5], "rotation": [0.6428, 0, 0, 0.766], "extensions": {"ETD_optics": {
//         "light": {"class": "rays", "file": "led.dat", "flux": 8}}}}]}

// A file on the device, twin in host/photometry/ray_set.h. Layout of ray_words from `first`:
//   where rays are uneven, of each ray: a threshold in 2^24, the ray that stands in for it above that
//   where there are several colours, of each ray: which
//   of each ray: position, m, and direction, as bits of floats, and where rays are polarized S1 to S3 over S0 and their x axis
struct RayFileRef {
    uint first;
    uint count;
    uint uneven;
    uint colors;       // 0: the light's own; 1: all rays have the same
    uint first_color;  // in ray_colors
    float flux;        // lm
    float scale;       // of the light's own colour
    uint polarized;
    vec3 lo, hi;       // m, of where rays start
};

struct RaysLight {
    Placement placement;
    float flux;         //: 0 in [0, inf) lm. Luminous flux of all rays together; 0: as the file says.
    SpectrumRef color;  //: 1 in [0, inf). Colour of the rays where the file tells no wavelengths; how bright it is does not count.
    RayFileRef file;    //: required. Ray file: .tm25ray, .dat, .sdf, .ray or .txt.
};

layout(scalar, set = 0) readonly buffer RayWords { uint ray_words[]; };
layout(scalar, set = 0) readonly buffer RayColors { SpectrumRef ray_colors[]; };

// The file's axes in the world.
mat3 rays_frame(RaysLight r) { return node_frame(r.placement.world_from_local); }

float rays_flux(RaysLight r) { return r.file.flux > 0.0 && r.flux > 0.0 ? r.flux : r.file.flux; }

LightSample rays_sample_towards(RaysLight r, vec3 point, vec2 u) { return no_light_sample(); }
float rays_pdf_towards(RaysLight r, vec3 point, vec3 direction, LightHit hit) { return 0.0; }
Spectrum rays_radiance(RaysLight r, vec3 direction, LightHit hit) { return Spectrum(0); }

// Which ray: 32 bits of two numbers find the entry of the alias table (Walker 1977), a third number chooses in it.
uint rays_draw(RayFileRef f, float u, float more, float within) {
    uint entry, rest;
    umulExtended((uint(u * 16777216.0) << 8) | (uint(more * 16777216.0) >> 16), f.count, entry, rest);
    if (f.uneven == 0u) return entry;
    uint at = f.first + 2u * entry;
    return uint(within * 16777216.0) < ray_words[at] ? entry : ray_words[at + 1u];
}

// The same, of the numbers that a ray is emitted by.
uint rays_draw(RayFileRef f, vec2 u_position, vec2 u_direction) { return rays_draw(f, u_position.x, u_direction.x, u_position.y); }

// Of the colours, if there are several; behind them, of what else rays have.
uint rays_colors_at(RayFileRef f) { return f.first + (f.uneven != 0u ? 2u * f.count : 0u); }
uint rays_place(RayFileRef f, uint ray) {
    return rays_colors_at(f) + (f.colors > 1u ? f.count : 0u) + (f.polarized != 0u ? 12u : 6u) * ray;
}
vec3 rays_vector(uint at) { return uintBitsToFloat(uvec3(ray_words[at], ray_words[at + 1u], ray_words[at + 2u])); }

EmittedRay rays_emit(RaysLight r, SceneBounds bounds, vec2 u_position, vec2 u_direction) {
    RayFileRef f = r.file;
    float flux = rays_flux(r);
    if (!(flux > 0.0)) return no_emitted_ray();
    uint ray = rays_draw(f, u_position, u_direction), at = rays_place(f, ray);
    SpectrumRef color = r.color;
    float scale = flux * f.scale;
    if (f.colors > 0u) {
        color = ray_colors[f.first_color + (f.colors > 1u ? ray_words[rays_colors_at(f) + ray] : 0u)];
        scale = flux;
    }
    mat3 frame = rays_frame(r);
    vec3 direction = normalize(frame * rays_vector(at + 3u));
    return EmittedRay(r.placement.world_from_local[3] + frame * rays_vector(at), vec3(0), direction, direction, untinted_value(color) * scale,
                      1.0, true, true);
}

LightStokes rays_emitted_stokes(RaysLight r, vec2 u_position, vec2 u_direction) {
    if (r.file.polarized == 0u) return no_light_stokes();
    uint at = rays_place(r.file, rays_draw(r.file, u_position, u_direction));
    vec3 axis = rays_frame(r) * rays_vector(at + 9u);
    return LightStokes(rays_vector(at + 6u), axis / max(length(axis), 1e-30));
}

float rays_pdf_emit(RaysLight r, SceneBounds bounds, vec3 direction, LightHit hit) { return 1.0; }
float rays_power(RaysLight r, SceneBounds bounds) { return rays_flux(r); }

void rays_bounds(RaysLight r, out vec3 lo, out vec3 hi) {
    mat3 f = rays_frame(r);
    vec3 middle = f * (0.5 * (r.file.lo + r.file.hi)), size = 0.5 * (r.file.hi - r.file.lo);
    vec3 extent = abs(f[0]) * size.x + abs(f[1]) * size.y + abs(f[2]) * size.z;
    lo = r.placement.world_from_local[3] + middle - extent;
    hi = lo + 2.0 * extent;
}

LightCone rays_cone(RaysLight r) { return unmet_rays(); }
