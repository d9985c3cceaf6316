// A luminance meter: the mean luminance within a narrow cone around -z of its node, as a spot meter shows it. With more than one pixel,
// columns divide the turn about the axis and rows the solid angle, from the axis outwards. A pixel: cd/m².
//
// Example:
//     {"nodes": [{"name": "meter", "translation": [0.2, 1.1, 4], "extensions": {"ETD_optics": {
//         "receiver": {"class": "luminance_meter", "angle": 0.3}}}}]}
struct LuminanceMeter {
    Placement placement;
    float angle;      //: 0.01745329252 in (0, 3.1415926] rad. Of the whole cone.
    vec2 resolution;  //: [1, 1] in [1, 16384]. Pixels about the axis and outwards.
};

// sin² of half the angle from the axis to the rim.
float luminance_meter_rim(LuminanceMeter r) { return square(cos_sin_small(0.25 * r.angle).y); }
float luminance_meter_density(LuminanceMeter r) { return 1.0 / (4.0 * PI * luminance_meter_rim(r)); }
mat3 luminance_meter_frame(LuminanceMeter r) { return frame_around(-normalize(r.placement.world_from_local[2])); }

CameraRay luminance_meter_emit(LuminanceMeter r, vec2 film, vec2 u, float film_aspect) {
    float s = film.y * luminance_meter_rim(r);
    vec3 local = vec3(2.0 * sqrt(max(s * (1.0 - s), 0.0)) * cos_sin_turns(film.x), 1.0 - 2.0 * s);
    return CameraRay(r.placement.world_from_local[3], luminance_meter_frame(r) * local, 1.0, luminance_meter_density(r), 1.0, false,
                     false, 0u);
}

ReceiverSample luminance_meter_connect(LuminanceMeter r, vec3 point, vec2 u, float film_aspect) {
    vec3 d = point - r.placement.world_from_local[3];
    float distance = length(d);
    vec3 local = d * luminance_meter_frame(r) / distance;
    float rim = luminance_meter_rim(r), across = dot(local.xy, local.xy);
    float s = across / (2.0 + 2.0 * sqrt(max(0.0, 1.0 - across)));
    if (!(local.z > 0.0) || !(s < rim)) return no_receiver_sample();
    float turns = accurate_atan2(local.y, local.x) * (0.5 * INV_PI);
    return ReceiverSample(-d / distance, distance, vec2(turns - floor(turns), s / rim), luminance_meter_density(r), 1.0,
                          distance * distance);
}

float luminance_meter_footprint(LuminanceMeter r, vec3 point, float film_aspect, out float slope) {
    slope = inversesqrt(luminance_meter_density(r));
    return max(length(point - r.placement.world_from_local[3]), 1e-12) * slope;
}
