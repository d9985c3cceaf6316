// Views: the receivers that the same forward rays serve, each with a film of its own. The pixels of their films stand one after
// another. Backward paths of a view are those that it would have alone.
#include "features/defaults.glsl"
#include "features/receiver_kinds.glsl"
#include "lib/sampler.glsl"

// Twin: struct DeviceView of host/render/views.cpp.
struct View {
    uint receiver;       // RecordRef
    uint index;          // among the views
    uint first_pixel;
    uint width, height;  // of its film
    uint element;        // that it is in (features/elements.glsl)
    float share;         // of the forward vertices that are connected to it, where others are to other views; at receptors 1
};
layout(scalar, set = 0) readonly buffer Views { uint all_views; View views[]; };

#if SEVERAL_VIEWS
#define VIEW_COUNT all_views
View view_of(uint pixel) {
    uint v = 0u;
    while (v + 1u < all_views && pixel >= views[v + 1u].first_pixel) ++v;
    return views[v];
}
#else
#define VIEW_COUNT 1u
#define view_of(pixel) views[0]
#endif

float film_aspect(View v) { return float(v.width) / float(v.height); }
float pixel_count(View v) { return float(v.width) * float(v.height); }
uint pixel_of(View v, vec2 film) {
    uvec2 size = uvec2(v.width, v.height);
    uvec2 pixel = min(uvec2(film * vec2(size)), size - 1u);
    return v.first_pixel + pixel.y * size.x + pixel.x;
}

// The view that a forward vertex is connected to, if it is not at a receptor; NO_RECORD = those that there are have receptors.
uint choose_view(inout Sampler random) {
    uint chosen = NO_RECORD;
#if SEVERAL_VIEWS
    float u = sample_1d(random);
    for (uint v = 0u; v < VIEW_COUNT && u >= 0.0; ++v) {
        if (has_receptor(views[v].receiver)) continue;
        chosen = v;
        u -= views[v].share;
    }
#else
    if (!has_receptor(views[0].receiver)) chosen = 0u;
#endif
    return chosen;
}
