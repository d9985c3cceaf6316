// Every class of scene object: X(tag, Struct, name), one table per interface.
//
// The class stands in one file, FOLDER/name.glsl, with its record `Struct` and functions `name_…`. Where
// another interface has a class of that name the row says INTERFACE_name, and so do the functions; file and
// scenes keep the name. A tag is written into RecordRefs and never renumbered. Tags 128 to 254 are for
// classes that a scene brings along. The host reads this file as text; shaders see only the classes that a
// scene uses (see generated headers in host/scene/features.h).

// folder geometry/, contract interfaces/geometry.glsl
#define GEOMETRY_CLASSES(X)         \
    X(1, Triangle, triangle)        \
    X(2, Sphere, sphere)            \
    X(3, Disk, disk)                \
    X(4, Rectangle, rectangle)      \
    X(5, Cylinder, cylinder)        \
    X(6, Asphere, asphere)          \
    X(7, BezierPatch, bezier_patch) \
    X(9, Microstructure, microstructure)

// folder lights/, contract interfaces/light_source.glsl
#define LIGHT_CLASSES(X)                \
    X(1, AreaLight, area)               \
    X(2, PointLight, point)             \
    X(3, SpotLight, spot)               \
    X(4, DirectionalLight, directional) \
    X(5, ConstantEnvironment, constant) \
    X(6, ImageEnvironment, image)       \
    X(7, IesLight, ies)                 \
    X(8, SkyEnvironment, sky)           \
    X(9, RaysLight, rays)               \
    X(10, CollimatedLight, collimated)

// folder receivers/, contract interfaces/receiver.glsl
#define RECEIVER_CLASSES(X)                \
    X(1, PerspectiveCamera, perspective)   \
    X(2, OrthographicCamera, orthographic) \
    X(3, ThinLensCamera, thin_lens)        \
    X(4, PanoramaCamera, panorama)         \
    X(5, LuminanceMeter, luminance_meter)  \
    X(6, IlluminanceMeter, illuminance)    \
    X(7, IntensityMeter, intensity)        \
    X(8, RayRecorder, receiver_rays)       \
    X(9, SurfaceMeter, receiver_surface)

// folder surfaces/, contract interfaces/surface_optics.glsl
#define SURFACE_CLASSES(X)                           \
    X(1, Lambertian, lambertian)                     \
    X(2, Conductor, conductor)                       \
    X(3, Dielectric, dielectric)                     \
    X(4, ThinDielectric, thin_dielectric)            \
    X(5, Absorber, absorber)                         \
    X(6, Boundary, boundary)                         \
    X(7, Principled, principled)                     \
    X(8, DiffuseTransmitter, diffuse_transmitter)    \
    X(9, ThinFilm, thin_film)                        \
    X(10, Measured, measured)                        \
    X(11, LinearPolarizer, linear_polarizer)         \
    X(12, ReflectivePolarizer, reflective_polarizer) \
    X(13, Retarder, retarder)                        \
    X(14, Depolarizer, depolarizer)                  \
    X(15, ColorFilter, color_filter)                 \
    X(16, LcCell, lc_cell)                           \
    X(17, MuellerSheet, mueller)                     \
    X(18, MuellerTableSurface, mueller_table)        \
    X(19, Grating, grating)                          \
    X(20, Antireflective, antireflective)

// folder media/, contract interfaces/medium_optics.glsl
#define MEDIUM_CLASSES(X)               \
    X(1, Homogeneous, homogeneous)      \
    X(2, Grid, grid)                    \
    X(3, GradientIndex, gradient_index) \
    X(4, FishEye, fish_eye)             \
    X(5, Uniaxial, uniaxial)

// folder phases/, contract interfaces/phase_function.glsl
#define PHASE_CLASSES(X)                      \
    X(1, Isotropic, isotropic)                \
    X(2, HenyeyGreenstein, henyey_greenstein) \
    X(3, Rayleigh, rayleigh)                  \
    X(4, Mie, mie)
