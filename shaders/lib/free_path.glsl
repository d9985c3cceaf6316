// Free paths: how far light goes through a medium before it scatters.
#include "lib/constants.glsl"
#include "features/spectrum.glsl"

struct MediumRay {
    vec3 origin, direction;  // in world space; direction is unit
    float distance;          // m
    uint mode;               // MODE_… within a crystal (lib/crystal_waves.glsl)
};

struct FreePath {
    bool scatters;
    float distance;   // m, to where it scatters, or all there is
    Spectrum weight;  // transmittance to there, times the scattering coefficient if it scatters, over the density of that
    float passage;    // what an average lane leaves of light on the way, for weights (interfaces/medium_optics.glsl)
};

struct Passage {
    Spectrum transmittance;
    float mean;  // of an average lane, for weights
};

// -log(1 - x): the optical depth at which light scatters, by a number spread evenly over [0,1).
float free_depth(float x) { return x < 1e-3 ? x * (1.0 + x * (0.5 + x * (1.0 / 3.0))) : -log(max(1.0 - x, 0.0)); }

// Through a medium that is the same everywhere, whose lanes may differ: one is chosen in proportion to what it carries, and where
// its free path ends all scatter. Balance heuristic over the choices (Veach 1997, section 9.2.4): what the lanes carry together
// never grows. Coefficients in 1/m.
FreePath sample_free_path(Spectrum extinction, Spectrum scattering, float distance, Spectrum carried, vec2 u) {
    float sum = dot(carried, Spectrum(1));
    Spectrum share = sum > 0.0 ? carried / sum : Spectrum(1.0 / float(LANES));
    float start = 0.0, chosen = 0.0, rest = 0.0;
    for (uint i = 0u; i < LANES; ++i) {
        if (u.x >= start && share[i] > 0.0) {
            chosen = extinction[i];
            rest = (u.x - start) / share[i];
        }
        start += share[i];
    }
    // Random numbers are multiples of 2^-24: what is left of the choice adds the digits that thin media need.
    float depth = free_depth(u.y + min(rest, 1.0) * (1.0 / 16777216.0));
    float end = chosen > 0.0 ? depth / chosen : INFINITY;
    FreePath path;
    path.scatters = end < distance;
    path.distance = min(end, distance);
    Spectrum left = exp(-extinction * path.distance);
    float density = dot(share, path.scatters ? extinction * left : left);
    path.weight = density > 0.0 ? (path.scatters ? scattering * left : left) / density : Spectrum(0);
    path.passage = brightness(left);
    return path;
}
