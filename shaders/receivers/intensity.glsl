// A goniophotometer: the luminous intensity of the whole scene, as seen from far away, over the directions that light leaves it in.
// Photometric frame (CIE 121, C planes): gamma is the angle from -z of the node, C turns from +x towards +y. Columns are centred at
// C = 0 and on to the last before 360 degrees; rows at gamma = 0 and on to 180 degrees, so that the first and the last are half as
// high. A pixel is the mean over its solid angle; light that comes from outside counts as far as the scene sends it on, and an
// environment that is seen past it would have no intensity. Only the node's directions matter. A pixel: cd.
//
// Example:
//     {"nodes": [{"name": "goniophotometer", "rotation": [0.7071, 0, 0, 0.7071], "extensions": {"ETD_optics": {
//         "receiver": {"class": "intensity", "resolution": [24, 37]}}}}]}
struct IntensityMeter {
    Placement placement;
    vec2 resolution;  //: [360, 181] in [2, 16384]. Columns over C, rows over gamma.
};
#define intensity_HAS_APERTURE

// Columns: the directions C = 0, C = 90 degrees and gamma = 0.
mat3 intensity_frame(IntensityMeter r) {
    mat4x3 m = r.placement.world_from_local;
    vec3 down = -normalize(m[2]);
    vec3 c90 = normalize(cross(m[2], m[0]));
    if (dot(c90, m[1]) < 0.0) c90 = -c90;
    vec3 c0 = cross(c90, down);
    return mat3(dot(c0, m[0]) < 0.0 ? -c0 : c0, c90, down);
}

struct IntensityRow {
    float index;
    bool upper;    // nearer to gamma = 180 degrees, from where all else counts
    float lo, hi;  // half the angles at its ends
};

IntensityRow intensity_row(IntensityMeter r, float index) {
    float last = r.resolution.y - 1.0, reach = 0.25 * PI / last;
    bool upper = 2.0 * index > last;
    float middle = 0.5 * PI * ((upper ? last - index : index) / last);
    return IntensityRow(index, upper, max(middle - reach, 0.0), middle + reach);
}

float intensity_sine(float angle) { return cos_sin_turns(angle * (0.5 * INV_PI)).y; }

// The solid angle of the whole row over 4 pi: sin² of half the angle at one end less that at the other.
float intensity_ring(IntensityRow row) { return intensity_sine(row.hi + row.lo) * intensity_sine(row.hi - row.lo); }

// 1/sr
float intensity_density(IntensityMeter r, IntensityRow row) { return 1.0 / (4.0 * PI * r.resolution.y * intensity_ring(row)); }

// The direction of a point of the film, in the frame; within each row even over its solid angle.
vec3 intensity_direction(IntensityMeter r, vec2 film, out IntensityRow row) {
    float y = film.y * r.resolution.y;
    row = intensity_row(r, clamp(floor(y), 0.0, r.resolution.y - 1.0));
    float across = clamp(y - row.index, 0.0, 1.0);
    float s = square(intensity_sine(row.lo)) + (row.upper ? 1.0 - across : across) * intensity_ring(row);  // sin² of half the angle
    float sine = 2.0 * sqrt(max(s * (1.0 - s), 0.0)), cosine = 1.0 - 2.0 * s;
    return vec3(sine * cos_sin_turns(film.x - 0.5 / r.resolution.x), row.upper ? -cosine : cosine);
}

CameraRay intensity_emit(IntensityMeter r, vec2 film, vec2 u, float film_aspect) {
    IntensityRow row;
    vec3 direction = intensity_frame(r) * intensity_direction(r, film, row);
    vec3 origin = SCENE_RADIUS * (frame_around(direction) * vec3(warp_disk(u), 1.0));
    float disk = PI * square(SCENE_RADIUS), density = intensity_density(r, row);
    return CameraRay(origin, -direction, disk, density / disk, density, true, false, 0u);
}

// Any direction will do: one drawn as the film draws them.
ReceiverSample intensity_connect(IntensityMeter r, vec3 point, vec2 u, float film_aspect) {
    IntensityRow row;
    vec3 direction = intensity_frame(r) * intensity_direction(r, u, row);
    float disk = PI * square(SCENE_RADIUS), density = intensity_density(r, row);
    return ReceiverSample(direction, INFINITY, u, density / disk, disk, density);
}

ReceiverSample intensity_far(IntensityMeter r, vec3 direction, float film_aspect) {
    vec3 d = direction * intensity_frame(r);
    float level = length(d.xy), last = r.resolution.y - 1.0;
    IntensityRow row = intensity_row(r, clamp(floor(accurate_atan2(level, d.z) * INV_PI * last + 0.5), 0.0, last));
    float half_angle = 0.5 * accurate_atan2(level, row.upper ? -d.z : d.z);
    float across = intensity_sine(half_angle + row.lo) * intensity_sine(half_angle - row.lo) / intensity_ring(row);
    float y = clamp(row.upper ? 1.0 - across : across, 0.0, 0.9999);
    float turns = accurate_atan2(d.y, d.x) * (0.5 * INV_PI) + 0.5 / r.resolution.x;
    vec2 film = vec2(turns - floor(turns), (row.index + y) / r.resolution.y);
    float disk = PI * square(SCENE_RADIUS), density = intensity_density(r, row);
    return ReceiverSample(direction, INFINITY, film, density / disk, disk, density);
}

float intensity_footprint(IntensityMeter r, vec3 point, float film_aspect, out float slope) {
    slope = 0.0;
    return sqrt(PI) * SCENE_RADIUS;
}
