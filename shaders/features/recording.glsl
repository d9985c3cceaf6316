// What happens to a path, for kernels/record_paths.comp; other kernels keep none of it.
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
