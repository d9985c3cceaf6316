// What a scene has and what a kernel traces is said by the host before the kernel's source (host/scene/features.h,
// host/render/techniques.h). What it does not say is off. What kernels trace:
//   FORWARD           paths start at a light and carry flux instead of radiance
//   BIDIRECTIONAL     estimators from both ends are combined (features/mis.glsl)
//   CONNECT_VERTICES  … also by connecting vertices of backward paths with vertices of forward paths
//   MERGE_VERTICES    … also by merging them
//   BEAMS             … in media that are the same everywhere along rays
//   FORWARD_ONLY      what forward rays can bring is brought by nothing else
//   HAS_SPLATS        forward rays bring light to pixels
//   SEVERAL_VIEWS     several receivers share the forward rays (features/views.glsl)
//   RECORD_RAYS       rays are written down where they cross receivers (features/ray_record.glsl)
//   LIGHT_LAYERS      light is told apart, in so many layers (features/light_layers.glsl), and HAS_LIGHT_LAYERS
//   HAS_POWER_LEDGER  forward rays tell what each material has absorbed (features/power_ledger.glsl)
//   STOKES_IMAGE      the film has layers for S1 to S3 (features/stokes_images.glsl)
#ifndef FORWARD
#define FORWARD 0
#endif
#ifndef BIDIRECTIONAL
#define BIDIRECTIONAL 0
#endif
#ifndef CONNECT_VERTICES
#define CONNECT_VERTICES 0
#endif
#ifndef MERGE_VERTICES
#define MERGE_VERTICES 0
#endif
#ifndef BEAMS
#define BEAMS 0
#endif
#ifndef FORWARD_ONLY
#define FORWARD_ONLY 0
#endif
#ifndef SEVERAL_VIEWS
#define SEVERAL_VIEWS 0
#endif
#ifndef RECORD_RAYS
#define RECORD_RAYS 0
#endif
#ifndef STOKES_IMAGE
#define STOKES_IMAGE 0
#endif
#ifndef LIGHT_LAYERS
#define LIGHT_LAYERS 0
#endif
#ifndef HAS_LIGHT_LAYERS
#define HAS_LIGHT_LAYERS 0
#endif
#ifndef HAS_POWER_LEDGER
#define HAS_POWER_LEDGER 0
#endif
#ifndef HAS_SPLATS
#define HAS_SPLATS 0
#endif

// What scenes have, for kernels that are compiled without one:
#ifndef HAS_TRIANGLES
#define HAS_TRIANGLES 0
#endif
#ifndef HAS_ELEMENTS
#define HAS_ELEMENTS 0
#endif
#ifndef SCENE_LIGHT_COUNT
#define SCENE_LIGHT_COUNT LIGHT_COUNT
#endif
#ifndef HAS_SHAPES
#define HAS_SHAPES 0
#endif
#ifndef HAS_INSTANCES
#define HAS_INSTANCES 0
#endif
#ifndef HAS_VERTEX_ATTRIBUTES
#define HAS_VERTEX_ATTRIBUTES 0
#endif
#ifndef HAS_NORMAL_MAPS
#define HAS_NORMAL_MAPS 0
#endif
#ifndef HAS_TEXTURES
#define HAS_TEXTURES 0
#endif
#ifndef HAS_MEDIA
#define HAS_MEDIA 0
#endif
#ifndef HAS_SCATTERING
#define HAS_SCATTERING 0
#endif
#ifndef HAS_BENDING
#define HAS_BENDING 0
#endif
#ifndef HAS_INTERFACES
#define HAS_INTERFACES 0
#endif
#ifndef HAS_PRIORITIES
#define HAS_PRIORITIES 0
#endif
#ifndef HAS_SHADING_NORMALS
#define HAS_SHADING_NORMALS 0
#endif
#ifndef HAS_TWINS
#define HAS_TWINS 0
#endif
#ifndef HAS_EMISSION_MAPS
#define HAS_EMISSION_MAPS 0
#endif
#ifndef HAS_COVERAGE
#define HAS_COVERAGE 0
#endif
#ifndef HAS_STRAIGHT
#define HAS_STRAIGHT 0
#endif
#ifndef HAS_POLARIZATION
#define HAS_POLARIZATION 0
#endif
#ifndef HAS_CRYSTALS
#define HAS_CRYSTALS 0
#endif
#ifndef HAS_GENERAL_MUELLER
#define HAS_GENERAL_MUELLER 0
#endif
#ifndef HAS_BODY_MUELLER
#define HAS_BODY_MUELLER 0
#endif
#ifndef HAS_POLARIZED_LIGHTS
#define HAS_POLARIZED_LIGHTS 0
#endif
#ifndef HAS_POLARIZED_RAYS
#define HAS_POLARIZED_RAYS 0
#endif
#ifndef HAS_APERTURES
#define HAS_APERTURES 0
#endif
#ifndef HAS_RECEPTOR_SHAPES
#define HAS_RECEPTOR_SHAPES 0
#endif
#ifndef HAS_RECEPTORS
#define HAS_RECEPTORS 0
#endif
#ifndef HAS_SURFACE_METERS
#define HAS_SURFACE_METERS 0
#endif
#ifndef HAS_FAR_RECEIVERS
#define HAS_FAR_RECEIVERS 0
#endif
#ifndef HAS_DISPERSION
#define HAS_DISPERSION 0
#endif
#ifndef HAS_UNROLLED_TRAVERSAL
#define HAS_UNROLLED_TRAVERSAL 0
#endif
#ifndef INDEPENDENT_SAMPLES
#define INDEPENDENT_SAMPLES 0
#endif
#ifndef SPECTRAL
#define SPECTRAL 0
#endif
#ifndef SPECTRAL_BINS
#define SPECTRAL_BINS 0
#endif

// Shadow rays may end at forward vertices or lights, whose light is polarized.
#if HAS_POLARIZATION && !FORWARD && (CONNECT_VERTICES || HAS_POLARIZED_LIGHTS)
#define HAS_POLARIZED_ENDS 1
#else
#define HAS_POLARIZED_ENDS 0
#endif

// Of kernels/find_hits.comp: any hit will do.
#ifndef ANY_HIT
#define ANY_HIT 0
#endif
