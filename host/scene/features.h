// What a scene needs, as the shaders see it: macros in front of every kernel, and one header of classes per
// interface. Only what is listed here is compiled; record layouts never depend on it.
#pragma once
#include <cstdint>
#include <string>

namespace etendue {

constexpr uint32_t most_bodies =
    16;  // materials with a priority: what shaders/features/bodies.glsl can count

struct Features {
    bool triangles = false;           // the world hierarchy holds triangles
    bool shapes = false;              // … analytic shapes
    bool instances = false;           // … instances of meshes
    bool elements = false;            // optical elements
    bool unrolled_traversal = false;  // so few primitives that straight code tests them all
    bool vertex_attributes = false;   // normals, tangents, texture coordinates or colors
    bool normal_maps = false;
    bool shading_normals = false;  // some normals are not those of the surface
    bool textures = false;
    bool media = false;             // some medium absorbs or scatters
    bool scattering = false;        // some medium scatters
    bool even_scattering = false;   // … the same everywhere
    bool bending = false;           // some medium bends rays
    bool interfaces = false;        // some surface separates media: paths keep track of where they are
    uint32_t body_count = 0;        // materials with a priority: paths count the bodies that they are inside
    bool straight = false;          // some surface lets light pass straight on: shadow rays go through
    bool emission_maps = false;     // some light is sampled by how bright its parts are
    bool twins = false;             // some sheets are two triangles, one for each side
    bool coverage = false;          // some surface emits and is there in part
    bool spectral = false;          // paths carry wavelengths instead of colours
    bool polarization = false;      // paths carry Stokes vectors
    bool polarized_lights = false;  // some light is polarized from the start
    bool polarized_rays = false;    // … ray by ray
    bool body_mueller = false;      // a class polarizes what its body sends out
    bool general_mueller =
        false;                    // a class has matrices that are not of two blocks (shaders/lib/stokes.glsl)
    bool crystals = false;        // some medium refracts doubly
    bool apertures = false;       // some receiver draws its rays from many (shaders/interfaces/receiver.glsl)
    bool far_receivers = false;   // … is far away
    bool surface_meters = false;  // … lies on the surface of a mesh
    bool receptor_shapes = false;  // … is no plane (shaders/features/receptor_shapes.glsl)
    bool receptors = false;        // … has a receptor, which is made of this material:
    uint32_t receptor_material = 0;
    bool dispersion = false;           // some direction depends on the wavelength
    uint32_t spectrum_count = 0;       // room for so many
    bool independent_samples = false;  // hashes take the place of Sobol' points
    bool light_tree = false;
    uint32_t spectral_bins = 0;      // of a spectral image; set by the renderer
    uint32_t texture_formats = 7;    // of features/textures.glsl, a bit each
    uint32_t bvh_stack_size = 64;    // references that a traversal can hold back
    uint32_t light_count = 0;        // finite and infinite lights
    uint32_t scene_light_count = 0;  // … those within no element
    uint32_t infinite_light_count = 0;
    float scene_radius = 0;  // m, of a sphere around all geometry

    static Features everything();  // for lint and reflection
    std::string defines() const;
};

}  // namespace etendue
