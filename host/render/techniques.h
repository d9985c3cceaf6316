// Which estimators a scene is rendered with.
#pragma once
#include <string>

#include "host/render/modes.h"
#include "host/scene/scene.h"

namespace etendue {

// The estimators of a pass; as macros they stand before every kernel (shaders/lib/path.glsl).
struct Techniques {
    bool forward = false;        // there are forward rays
    bool bidirectional = false;  // backward and forward rays are weighted against each other
    bool connect = false;        // vertices are connected
    bool merge = false;          // vertices are merged
    bool beams = false;          // … in media that are the same everywhere along rays
    bool stokes = false;         // the film has layers for S1 to S3 (shaders/features/stokes_images.glsl)
    bool several_views = false;  // forward rays serve several receivers (host/render/views.h)
    bool ray_record = false;     // of what crosses some of them (host/render/ray_record.h)
    uint32_t light_layers = 0;   // … for so many layers of light, with these defines (host/render/light_layers.h)
    std::string layer_defines;
    bool ledger = false;  // forward rays tell what each material has absorbed
    std::string backward_defines() const, forward_defines() const;
};

// Marks the materials that scatter into narrow lobes (asked of the classes on the device, once a scene);
// returns whether there are any, or media that bend rays, which are like them.
bool find_narrow_materials(Device& device, Scene& scene);

// Whether a light is seen under a small solid angle for its share of the power, and whether one is a point or
// a narrow beam (asked of the classes on the device).
struct CompactLights {
    bool any = false, points = false;
};
CompactLights find_compact_lights(Device& device, Scene& scene);

// Vertices merge only behind narrow surfaces; a scene without light is left to backward rays.
Techniques choose_techniques(Device& device, Scene& scene, Algorithm algorithm);

}  // namespace etendue
