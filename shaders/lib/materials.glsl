// What a surface is made of: how it scatters, what it separates, what it emits.
#include "lib/records.glsl"
#include "features/spectrum.glsl"
#include "features/textures.glsl"

struct Material {
    SpectrumRef emission;         // radiance, before the texture
    uint surface;                 // RecordRef
    uint inside;                  // medium on the side that the geometric normal points away from; NO_RECORD = vacuum
    uint outside;
    uint flags;
    TextureRef emission_texture;
    TextureRef normal_texture;    // tangent space, in [0, 1]
    float normal_scale;
    uint body;                    // place among the materials with a priority (features/bodies.glsl); NO_RECORD = none
};

const uint MATERIAL_EMITS_BOTH_SIDES = 1u;
const uint MATERIAL_SEPARATES_MEDIA = 2u;  // inside and outside hold; without it a ray that passes stays where it is
const uint MATERIAL_OPAQUE = 4u;           // nothing passes straight on
const uint MATERIAL_NARROW = 8u;           // scatters into narrow lobes: perfectly smooth or nearly so, in part at least
const uint MATERIAL_BLOCKS = 16u;          // nothing passes at all; known only where bodies have priorities

layout(scalar, set = 0) readonly buffer Materials { Material materials[]; };

bool material_emits_both_sides(uint material) { return (materials[material].flags & MATERIAL_EMITS_BOTH_SIDES) != 0u; }

// Radiance that leaves a point of the surface, on the side of the geometric normal (front) or the other.
Spectrum material_emission(uint material, bool front, vec2 uv0, vec2 uv1) {
    if (!front && !material_emits_both_sides(material)) return Spectrum(0);
    return untinted_value(materials[material].emission) *
           factor_of_rgb(texture_value(materials[material].emission_texture, uv0, uv1).rgb);
}
