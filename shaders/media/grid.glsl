// A medium whose density varies in space, from a file: absorption and scattering are in proportion to it.
//
// Free paths are sampled without bias by tracking with null collisions: in each brick of the grid (lib/density_grid.glsl)
// light collides as often as at the greatest density there, and a collision is real or null with probabilities in proportion
// to what all lanes together lose to either (Kutz et al. 2017, "Spectral and Decomposition Tracking for Rendering Heterogeneous
// Volumes", section 5, with probabilities by what the lanes still carry): what the lanes carry together never grows. Shadow
// rays are attenuated by residual ratio tracking (Novák et al. 2014, "Residual Ratio Tracking for Estimating Attenuation in
// Participating Media", section 3.2), with the least density of a brick as the control.
//
// Example:
//     {"materials": [{"name": "cloud", "extensions": {"ETD_optics": {
//         "surface": {"class": "boundary"}, "inside": "cloud"}}}],
//      "extensions": {"ETD_optics": {"media": [
//         {"name": "cloud", "class": "grid", "density": 0.0039, "scattering": 12, "phase": {"class": "henyey_greenstein", "g": 0.5},
//          "file": {"name": "cloud.nrrd", "translation": [0, 0.27, 0], "scale": [0.0027, 0.0027, 0.0027]}}]}}}
#include "lib/density_grid.glsl"
#include "lib/free_path.glsl"
#include "lib/plain_media.glsl"

struct Grid {
    GridRef file;            //: required. OpenVDB or NRRD file, or {"name", "grid", "translation", "rotation", "scale"}.
    float density;           //: 1 in [0, inf). Multiplies the densities of the file.
    SpectrumRef absorption;  //: 0 in [0, inf) 1/m. Absorption coefficient at density 1.
    SpectrumRef scattering;  //: 0 in [0, inf) 1/m. Scattering coefficient at density 1.
    SpectrumRef ior;         //: 1 in [0.1, 100] ior. Real refractive index.
    PhaseRef phase;          //: {"class":"isotropic"}. Phase function, by which it scatters.
};

Spectrum grid_ior(Grid r, vec3 position) { return untinted_value(r.ior); }

// At density 1.
Spectrum grid_unit_extinction(Grid r) { return r.density * (untinted_value(r.absorption) + untinted_value(r.scattering)); }

bool grid_is_clear(Grid r) { return is_black(grid_unit_extinction(r)); }

bool grid_scatters(Grid r) { return !is_black(r.density * untinted_value(r.scattering)); }

// Of an average lane where the bricks' mean densities on the way sum up to `column`, in m. Not below what weights can divide by.
float grid_mean_passage(Spectrum extinction, float column) { return max(brightness(exp(-extinction * column)), 1e-12); }

// [0, 1), from a generator that tracking starts for each ray: PCG (O'Neill 2014), 32 bits.
float next_number(inout uint state) {
    state = state * 747796405u + 2891336453u;
    uint word = ((state >> ((state >> 28) + 4u)) ^ state) * 277803737u;
    return min(float((word >> 22) ^ word) * (1.0 / 4294967296.0), 1.0 - EPSILON);
}

FreePath grid_free_path(Grid r, MediumRay ray, Spectrum carried, vec2 u, uint seed) {
    Spectrum extinction = grid_unit_extinction(r), scattering = r.density * untinted_value(r.scattering);
    if (is_black(carried)) carried = Spectrum(1);
    float top = max_component(mix(extinction, Spectrum(0), lessThanEqual(carried, Spectrum(0))));
    FreePath path = FreePath(false, ray.distance, Spectrum(1), 1.0);
    DensityWalk w = begin_walk(r.file, ray);
    float column = 0.0, most = walk_greatest_rate(w);
    // The digits that thin media need: numbers of the path are multiples of 2^-24.
    float depth = free_depth(u.y + next_number(seed) * (1.0 / 16777216.0)), choice = u.x;
    bool walking = w.t < w.end;
    do {  // no loop that lanes leave one by one (see features/light_selection.glsl)
        if (walking) {
            float rate = min(top * w.here.greatest, most), there = rate * (w.leaves - w.t);
            if (there > depth) {
                float next = min(w.t + depth / rate, w.leaves);
                column += w.here.mean * (next - w.t);
                w.t = next;
                float density = min(walk_density(w), rate / top);
                Spectrum share = carried * path.weight, null = max(rate - extinction * density, Spectrum(0));
                float sum = dot(share, Spectrum(1)), real_sum = density * dot(share, extinction), null_sum = dot(share, null);
                path.scatters = !(null_sum > 0.0) || choice * (real_sum + null_sum) < real_sum;
                path.weight *= path.scatters ? scattering * (density * sum / real_sum) : null * (sum / null_sum);
                if (path.scatters) path.distance = w.t;
                walking = !path.scatters;
                depth = free_depth(next_number(seed));
                choice = next_number(seed);
            } else {
                column += w.here.mean * (w.leaves - w.t);
                depth -= there;
                next_brick(w);
                walking = w.t < w.end;
            }
        }
    } while (subgroupAny(walking));
    path.passage = grid_mean_passage(extinction, column);
    return path;
}

Passage grid_pass(Grid r, MediumRay ray, uint seed) {
    Spectrum extinction = grid_unit_extinction(r);
    float top = max_component(extinction);
    DensityWalk w = begin_walk(r.file, ray);
    Spectrum left = Spectrum(1);  // of what the least densities leave
    float column = 0.0, least_column = 0.0, most = walk_greatest_rate(w);
    float depth = free_depth(next_number(seed));
    bool walking = w.t < w.end;
    do {
        if (walking) {
            float rate = min(top * (w.here.greatest - w.here.least), most), there = rate * (w.leaves - w.t);
            float next = there > depth ? min(w.t + depth / rate, w.leaves) : w.leaves;
            column += w.here.mean * (next - w.t);
            least_column += w.here.least * (next - w.t);
            if (there > depth) {
                w.t = next;
                float density = min(walk_density(w) - w.here.least, rate / top);
                left *= max(1.0 - extinction * (density / rate), Spectrum(0));
                depth = free_depth(next_number(seed));
                // Russian roulette, so that what is thick costs no more than what is not.
                if (max_component(left) < 0.1) left *= next_number(seed) < 0.5 ? 2.0 : 0.0;
                walking = !is_black(left);
            } else {
                depth -= there;
                next_brick(w);
                walking = w.t < w.end;
            }
        }
    } while (subgroupAny(walking));
    return Passage(left * exp(-extinction * least_column), grid_mean_passage(extinction, column));
}

bool grid_is_even(Grid r) { return false; }

float grid_mean_extinction(Grid r, vec3 position) {
    return density_at(r.file, position) * brightness(grid_unit_extinction(r));
}

Spectrum grid_scattering(Grid r, vec3 position) {
    return r.density * density_at(r.file, position) * untinted_value(r.scattering);
}

uint grid_phase(Grid r) { return r.phase.ref; }

NEVER_BENDS(Grid, grid)
