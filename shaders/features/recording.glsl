// What happens to a path, for kernels/record_paths.comp; other kernels keep none of it.
#include "features/crystals.glsl"
#include "lib/path.glsl"
#include "lib/primitives.glsl"

#ifdef RECORD_PATHS
struct RecordedEvent {
    vec3 position;
    uint event, material, light;
    float arriving;  // luminance of what the path carries there
    bool happened, followed;
};
RecordedEvent recorded_event;
uint recorded_light;  // that a forward path has left

// S1 to S3 over S0 of what the path carries, the mean of the lanes as the eye weighs them, and x of their frame; 0 where paths
// carry none.
#if HAS_POLARIZATION
void recorded_polarization(Path path, out vec3 stokes, out vec3 axis) {
    Polarization p = path.polarization;
    axis = stokes_axis(FORWARD == 1 ? path.direction : -path.direction);
    float carried = luminance(path.throughput);
    stokes = vec3(luminance(path.throughput * p.s1), luminance(path.throughput * p.s2), luminance(path.throughput * p.s3));
    stokes = carried > 0.0 ? stokes / carried : vec3(0);
    crystal_polarization(path.direction, path.around.medium, mode_of(path), stokes, axis);
}
#else
#define recorded_polarization(path, stokes, axis) (stokes = axis = vec3(0))
#endif

void record_light(uint light) { recorded_light = light; }
void record_event(Path path, SurfacePoint p, uint event) {
    recorded_event = RecordedEvent(p.position, event, p.material, p.light, luminance(path.throughput), true, false);
}
void record_departure() { recorded_event.followed = true; }
#else
#define record_light(light)
#define record_event(path, p, event)
#define record_departure()
#endif
