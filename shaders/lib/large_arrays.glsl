// Arrays that may be larger than one binding can show (128 MiB on lavapipe). The host decides for each: X_BY_ADDRESS reads it
// through its address, which costs a little more on some drivers. The accessors name_at(i) hide which.
#ifndef NODES_BY_ADDRESS
#define NODES_BY_ADDRESS 0
#define PRIMITIVES_BY_ADDRESS 0
#define VERTICES_BY_ADDRESS 0
#define TRIANGLE_INDICES_BY_ADDRESS 0
#define TEXELS_BY_ADDRESS 0
#define ENVIRONMENT_TEXELS_BY_ADDRESS 0
#define DENSITY_VALUES_BY_ADDRESS 0
#define MEASURED_POINTS_BY_ADDRESS 0
#define MEASURED_SPECTRA_BY_ADDRESS 0
#endif

layout(scalar, set = 0) readonly buffer LargeArrays {
    uvec2 nodes_address;
    uvec2 primitives_address;
    uvec2 vertices_address;
    uvec2 triangle_indices_address;
    uvec2 texels_address;
    uvec2 environment_texels_address;
    uvec2 density_values_address;
    uvec2 measured_points_address;
    uvec2 measured_spectra_address;
};
