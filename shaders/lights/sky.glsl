// A sky of the CIE, and the sun: the standard general sky of ISO 15469:2004 (CIE S 011), types 1 to 15, scaled to the illuminance that it
// gives a horizontal plane. 1 is overcast, 5 uniform, 12 clear, 15 clear and polluted. Below the horizon is even ground.
//
// Where the sun is: a direction, +y up, or {"latitude": 48.1, "longitude": 11.6, "time": "2026-06-21T14:00:00+02:00", "north": 0}:
// degrees, north and east positive; ISO 8601 with its zone. There -z is north and +x east; `north` (rad) turns both about +y,
// counter-clockwise seen from above. Types 1, 3 and 5 need no sun where `direct` is 0.
//
// The sun is a disk of 0.53°, of even luminance. Its rays and those of the rest are drawn in proportion to their flux: the former evenly
// over the disk, the latter by a map of the sky of 256 x 128 texels (lib/environment_map.glsl), while radiance is exact.
//
// Example:
//     {"extensions": {"ETD_optics": {"environment": {"class": "sky", "type": 12, "diffuse": 0.6, "direct": 2,
//         "sun": {"latitude": 48.1, "longitude": 11.6, "time": "2026-06-21T09:00:00+02:00", "north": 0.8}}}}}
#include "lib/environment_map.glsl"

// Made from the parameters; twin in host/lights/sky.h.
struct SkyRef {
    EnvironmentMapRef map;     // luminance of all but the sun
    vec3 sun;                  // unit, towards its middle
    float a, b, c, d, e;       // of gradation and indicatrix (ISO 15469, table 1)
    float sky, disk;           // radiance of the sky by its formula, and of the sun, over that of the colour
    float ground_of_sky, ground_of_sun;  // radiance of the ground, by the light of either, likewise
    float chord;               // from the sun's middle to its rim, on the unit sphere
    float sun_share;           // of the rays
    float integral;            // of luminance over all directions, sr cd/m^2
};

struct SkyEnvironment {
    uint type;               //: 12 in [1, 15]. Of the CIE.
    float diffuse;           //: required in [0, 1e9] lx. Illuminance of a horizontal plane by the sky alone.
    float direct;            //: 0 in [0, 1e9] lx. Illuminance of a plane that faces the sun, by it alone.
    SunDirection sun;        //: none. Direction towards the sun, or place and time.
    SpectrumRef color;       //: 1 in [0, inf). Colour of the sky; how bright it is does not matter.
    SpectrumRef sun_color;   //: [1.112, 0.975, 0.914] in [0, inf). Colour of the sun; else that of a black body of 5778 K.
    float ground;            //: 0.2 in [0, 1]. Reflectance of the ground, which is diffuse and lit by sky and sun.
    SkyRef sky;
};

bool sky_is_sun(SkyRef s, vec3 direction) {
    vec3 off = direction - s.sun;
    return dot(off, off) <= square(s.chord);
}

Spectrum sky_radiance(SkyEnvironment r, vec3 direction, LightHit hit) {
    SkyRef s = r.sky;
    bool is_sky = direction.y > 0.0;
    vec3 off = direction - s.sun;
    float angle = 2.0 * accurate_asin(0.5 * length(off));
    float gradation = 1.0 + s.a * exp(s.b / max(direction.y, 1e-6));
    float indicatrix = 1.0 + s.c * (exp(s.d * angle) - exp(s.d * 0.5 * PI)) + s.e * square(dot(direction, s.sun));
    float sky = is_sky ? s.sky * gradation * indicatrix : s.ground_of_sky;
    float sun = is_sky ? (dot(off, off) <= square(s.chord) ? s.disk : 0.0) : s.ground_of_sun;
    return untinted_value(r.color) * sky + untinted_value(r.sun_color) * sun;
}

float sky_pdf_towards(SkyEnvironment r, vec3 point, vec3 direction, LightHit hit) {
    SkyRef s = r.sky;
    float map = s.map.integral > 0.0 ? luminance(environment_radiance(s.map, 0.0, direction)) / s.map.integral : 0.0;
    return (1.0 - s.sun_share) * map + (sky_is_sun(s, direction) ? s.sun_share * INV_PI / square(s.chord) : 0.0);
}

// Evenly over the disk: solid angle goes with the square of the chord.
vec3 sky_sun_direction(SkyRef s, vec2 u) {
    float chord = s.chord * sqrt(u.x);
    vec3 across = frame_around(s.sun) * vec3(cos_sin_turns(u.y), 0.0);
    return s.sun * (1.0 - 0.5 * square(chord)) + across * (chord * sqrt(1.0 - 0.25 * square(chord)));
}

LightSample sky_sample_towards(SkyEnvironment r, vec3 point, vec2 u) {
    SkyRef s = r.sky;
    bool is_sun = u.x < s.sun_share;
    if (!is_sun && !(s.map.integral > 0.0)) return no_light_sample();
    u.x = min(is_sun ? u.x / s.sun_share : (u.x - s.sun_share) / (1.0 - s.sun_share), 1.0 - EPSILON);
    vec3 direction = is_sun ? sky_sun_direction(s, u) : environment_sample(s.map, 0.0, u).direction;
    LightHit hit = LightHit(vec3(0), vec3(0), vec2(0), vec2(0));
    float pdf = sky_pdf_towards(r, point, direction, hit);
    return LightSample(direction, INFINITY, sky_radiance(r, direction, hit), pdf, pdf * outer_disk_pdf(scene_bounds()), false);
}

EmittedRay sky_emit(SkyEnvironment r, SceneBounds bounds, vec2 u_position, vec2 u_direction) {
    LightSample l = sky_sample_towards(r, vec3(0), u_direction);
    return EmittedRay(outer_disk_point(bounds, -l.direction, u_position), vec3(0), -l.direction, -l.direction, l.radiance,
                      l.pdf * outer_disk_pdf(bounds), false, true);
}

float sky_pdf_emit(SkyEnvironment r, SceneBounds bounds, vec3 direction, LightHit hit) {
    return sky_pdf_towards(r, vec3(0), direction, hit) * outer_disk_pdf(bounds);
}

float sky_power(SkyEnvironment r, SceneBounds bounds) { return PI * square(bounds.radius) * r.sky.integral; }

void sky_bounds(SkyEnvironment r, out vec3 lo, out vec3 hi) { lo = vec3(1), hi = vec3(-1); }

LightCone sky_cone(SkyEnvironment r) { return whole_sphere_cone(); }
