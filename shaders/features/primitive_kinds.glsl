// Kinds of primitives; those that the scene lacks are known to be absent.
const uint KIND_TRIANGLE = 0u;
const uint KIND_SHAPE = 1u;
const uint KIND_INSTANCE = 2u;
const uint KIND_BOUNDARY = 3u;  // a triangle of an element's boundary (features/elements.glsl)
uint attributes_kind(uint attributes) { return attributes >> 30; }

#if HAS_ELEMENTS
#define is_boundary(attributes) (attributes_kind(attributes) == KIND_BOUNDARY)
#else
#define is_boundary(attributes) false
#endif

#if HAS_SHAPES || HAS_INSTANCES
#define ONLY_TRIANGLES false
#define is_triangle(attributes) (HAS_TRIANGLES == 1 && (attributes_kind(attributes) == KIND_TRIANGLE || is_boundary(attributes)))
#else
#define ONLY_TRIANGLES true
#define is_triangle(attributes) (HAS_TRIANGLES == 1)
#endif

#if HAS_SHAPES
#define is_shape(attributes) (attributes_kind(attributes) == KIND_SHAPE)
#else
#define is_shape(attributes) false
#endif

#if HAS_INSTANCES
#define is_instance(attributes) (attributes_kind(attributes) == KIND_INSTANCE)
#else
#define is_instance(attributes) false
#endif
