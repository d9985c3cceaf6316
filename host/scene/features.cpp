#include "host/scene/features.h"

#include <fmt/format.h>

#include "host/spectra/color.h"

namespace etendue {

Features Features::everything() {
    Features f;
    f.triangles = f.shapes = f.instances = f.vertex_attributes = f.normal_maps = f.shading_normals =
        f.textures = true;
    f.media = f.scattering = f.bending = f.interfaces = f.straight = f.coverage = f.emission_maps = f.twins =
        f.light_tree = true;
    f.general_mueller = f.body_mueller = f.crystals = true;
    f.apertures = f.surface_meters = f.far_receivers = f.receptors = f.receptor_shapes = true;
    f.body_count = most_bodies;
    f.light_count = 16;
    f.infinite_light_count = 2;
    f.scene_radius = 1;
    return f;
}

std::string Features::defines() const {
    std::string text;
    const auto define = [&](const char* name, uint32_t value) {
        text += fmt::format("#define {} {}\n", name, value);
    };
    define("HAS_TRIANGLES", triangles);
    define("HAS_SHAPES", shapes);
    define("HAS_INSTANCES", instances);
    define("HAS_ELEMENTS", elements);
    define("HAS_UNROLLED_TRAVERSAL", unrolled_traversal);
    define("HAS_VERTEX_ATTRIBUTES", vertex_attributes);
    define("HAS_NORMAL_MAPS", normal_maps);
    define("HAS_SHADING_NORMALS", shading_normals);
    define("HAS_TEXTURES", textures);
    define("HAS_MEDIA", media);
    define("HAS_SCATTERING", scattering);
    define("HAS_BENDING", bending);
    define("HAS_INTERFACES", interfaces);
    define("HAS_PRIORITIES", body_count > 0);
    if (body_count > 0) define("BODY_COUNT", body_count);
    define("HAS_STRAIGHT", straight);
    define("HAS_COVERAGE", coverage);
    define("HAS_EMISSION_MAPS", emission_maps);
    define("HAS_TWINS", twins);
    define("INDEPENDENT_SAMPLES", independent_samples);
    define("SPECTRAL", spectral);
    define("HAS_POLARIZATION", polarization);
    define("HAS_GENERAL_MUELLER", general_mueller);
    define("HAS_CRYSTALS", crystals);
    define("HAS_BODY_MUELLER", body_mueller);
    define("HAS_POLARIZED_LIGHTS", polarization && polarized_lights);
    define("HAS_POLARIZED_RAYS", polarization && polarized_rays);
    define("HAS_APERTURES", apertures);
    define("HAS_FAR_RECEIVERS", far_receivers);
    define("HAS_SURFACE_METERS", surface_meters);
    define("HAS_RECEPTORS", receptors);
    define("HAS_RECEPTOR_SHAPES", receptor_shapes);
    if (receptors) define("RECEPTOR_MATERIAL", receptor_material);
    define("HAS_DISPERSION", spectral && dispersion);
    if (spectral) define("SPECTRUM_COUNT", spectrum_count);
    if (spectral) define("COLOR_LATTICE", color_lattice);
    define("HAS_LIGHT_TREE", light_tree);
    if (spectral_bins > 0) define("SPECTRAL_BINS", spectral_bins);
    define("TEXTURE_FORMATS", texture_formats);
    define("BVH_STACK_SIZE", bvh_stack_size);
    define("LIGHT_COUNT", light_count);
    if (elements) define("SCENE_LIGHT_COUNT", scene_light_count);
    define("INFINITE_LIGHT_COUNT", infinite_light_count);
    text += fmt::format("#define SCENE_RADIUS {:.9e}\n", scene_radius);  // digits that tell floats apart
    return text;
}

}  // namespace etendue
