// A spectral quantity along a ray: a lane for each colour channel, linear Rec.709, or (SPECTRAL) for each of the four
// wavelengths of the pass. All paths of a pass carry the same wavelengths (host/spectra/wavelengths.h), so what a record's
// spectrum is worth at them is looked up once a pass, by the host.
#include "features/defaults.glsl"

// A spectral parameter of a record: filled by the host from any spectral value of the scene format.
struct SpectrumRef {
    vec3 rgb;    // linear Rec.709
    uint table;  // of spectrum_values; with TINTED_SPECTRUM rgb is a colour that multiplies it
};

// CIE luminance Y of linear Rec.709 (ITU-R BT.709-6).
float luminance(vec3 rgb) { return dot(rgb, vec3(0.2126, 0.7152, 0.0722)); }

#if SPECTRAL

#define Spectrum vec4
#define Stokes mat4
const uint LANES = 4u;
const uint TINTED_SPECTRUM = 0x80000000u;
const bool HAS_TINTS = HAS_TEXTURES == 1 || HAS_VERTEX_ATTRIBUTES == 1;  // something multiplies parameters by colours

// Twin of struct Wavelengths in host/spectra/wavelengths.h.
struct Wavelengths {
    vec4 nm;
    vec3 rgb[4];  // what a radiance of one contributes to the pixel
    vec4 share;   // the same to the radiance of the pixel over all wavelengths, W / (m^2 sr)
};
layout(scalar, set = 0) readonly buffer WavelengthTable { Wavelengths wavelengths[]; };  // of each pass of the batch
layout(scalar, set = 0) readonly buffer SpectrumValues { vec4 spectrum_values[]; };      // SPECTRUM_COUNT of each pass

// The pass that the invocation is at, in the batch.
uint batch_pass = 0u;
void begin_pass(uint pass) { batch_pass = pass; }

// The colour that a radiance has in the image.
vec3 spectrum_rgb(Spectrum s) {
    vec3 rgb = vec3(0);
    for (uint i = 0u; i < 4u; ++i) rgb += wavelengths[batch_pass].rgb[i] * s[i];
    return rgb;
}

float luminance(Spectrum s) { return luminance(spectrum_rgb(s)); }
Spectrum lane_wavelengths() { return wavelengths[batch_pass].nm; }  // nm
// A mean that samplers weigh choices by, and that importance is counted in.
float brightness(Spectrum s) { return dot(s, vec4(0.25)); }
float max_component(Spectrum s) { return max(max(s.x, s.y), max(s.z, s.w)); }

// Smooth spectra of colours (Jakob & Hanika 2019; host/spectra/color.h): coefficients on a lattice of the greatest channel,
// and the ratios of the two others to it.
layout(scalar, set = 0) readonly buffer ColorSpectra { vec4 color_spectra[]; };

Spectrum factor_of_rgb(vec3 rgb) {
    float greatest = max(rgb.x, max(rgb.y, rgb.z));
    if (rgb.x == rgb.y && rgb.y == rgb.z) return Spectrum(greatest);
    float scale = greatest > 1.0 ? 2.0 * greatest : 1.0;
    rgb /= scale, greatest /= scale;
    uint channel = rgb.x == greatest ? 0u : rgb.y == greatest ? 1u : 2u;
    vec2 ratios = vec2(rgb[(channel + 1u) % 3u], rgb[(channel + 2u) % 3u]) / greatest;
    const float last = float(COLOR_LATTICE - 1);
    float level = greatest < 0.5 ? sqrt(0.5 * greatest) : 1.0 - sqrt(0.5 * max(1.0 - greatest, 0.0));  // denser at both ends
    vec3 at = clamp(vec3(ratios, level) * last, vec3(0), vec3(last));
    uvec3 cell = min(uvec3(at), uvec3(COLOR_LATTICE - 2));
    vec3 f = at - vec3(cell);
    vec3 c = vec3(0);
    for (uint i = 0u; i < 8u; ++i) {
        uvec3 corner = uvec3(i & 1u, (i >> 1) & 1u, i >> 2);
        vec3 part = mix(1.0 - f, f, vec3(corner));
        uvec3 p = cell + corner;
        c += part.x * part.y * part.z *
             color_spectra[((channel * COLOR_LATTICE + p.z) * COLOR_LATTICE + p.y) * COLOR_LATTICE + p.x].xyz;
    }
    Spectrum t = (wavelengths[batch_pass].nm - 360.0) * (1.0 / 470.0);
    Spectrum x = (c.x * t + c.y) * t + c.z;
    return scale * (0.5 + 0.5 * x * inversesqrt(1.0 + x * x));
}

// Of four colours, in a loop, so that the code of one stands once.
void factors_of_rgb(vec3 a, vec3 b, vec3 c, vec3 d, out Spectrum of_a, out Spectrum of_b, out Spectrum of_c, out Spectrum of_d) {
    of_a = of_b = of_c = of_d = Spectrum(0);
    for (uint i = 0u; i < 4u; ++i) {
        Spectrum factor = factor_of_rgb(i == 0u ? a : i == 1u ? b : i == 2u ? c : d);
        if (i == 0u) of_a = factor;
        else if (i == 1u) of_b = factor;
        else if (i == 2u) of_c = factor;
        else of_d = factor;
    }
}

// Light of a colour, on D65, which is the first of the spectra.
Spectrum radiance_of_rgb(vec3 rgb) {
    float scale = 2.0 * max(rgb.x, max(rgb.y, rgb.z));
    if (!(scale > 0.0)) return Spectrum(0);
    return spectrum_values[batch_pass * SPECTRUM_COUNT] * scale * factor_of_rgb(rgb / scale);
}

// Of a parameter that scale_spectrum() is never applied to: less code.
Spectrum untinted_value(SpectrumRef ref) {
    return spectrum_values[batch_pass * SPECTRUM_COUNT + (ref.table & ~TINTED_SPECTRUM)];
}

Spectrum spectrum_value(SpectrumRef ref) {
    Spectrum value = untinted_value(ref);
    if (HAS_TINTS) {
        if ((ref.table & TINTED_SPECTRUM) != 0u) value *= factor_of_rgb(ref.rgb);
    }
    return value;
}

// Multiplies a parameter by a color, as textures do.
void scale_spectrum(inout SpectrumRef ref, vec3 color) {
    if (HAS_TINTS) {
        ref.rgb = (ref.table & TINTED_SPECTRUM) != 0u ? ref.rgb * color : color;
        ref.table |= TINTED_SPECTRUM;
    }
}

#else

#define Spectrum vec3
#define Stokes mat4x3
void begin_pass(uint pass) {}
const uint LANES = 3u;
vec3 spectrum_rgb(Spectrum s) { return s; }
Spectrum lane_wavelengths() { return vec3(611, 549, 464); }  // dominant ones of the channels, nm
float brightness(Spectrum s) { return luminance(s); }
float max_component(Spectrum s) { return max(s.x, max(s.y, s.z)); }
Spectrum factor_of_rgb(vec3 rgb) { return rgb; }
void factors_of_rgb(vec3 a, vec3 b, vec3 c, vec3 d, out Spectrum of_a, out Spectrum of_b, out Spectrum of_c, out Spectrum of_d) {
    of_a = a, of_b = b, of_c = c, of_d = d;
}
Spectrum radiance_of_rgb(vec3 rgb) { return rgb; }
Spectrum untinted_value(SpectrumRef ref) { return ref.rgb; }
Spectrum spectrum_value(SpectrumRef ref) { return ref.rgb; }
void scale_spectrum(inout SpectrumRef ref, vec3 color) { ref.rgb *= color; }

#endif

// The lane of the hero, the only wavelength left behind dispersion, of the path that the invocation is at (features/dispersion.glsl).
#if HAS_DISPERSION
uint hero = 0u;
float of_hero(Spectrum s) { return s[hero]; }
#else
#define of_hero(s) (s).x
#endif

// Of what sends each wavelength another way: without wavelengths all go as that of the d line, at which indices are taken, too.
Spectrum parting_wavelengths() { return SPECTRAL == 1 ? lane_wavelengths() : Spectrum(587.6); }  // nm
float of_parting(Spectrum s) { return SPECTRAL == 1 ? of_hero(s) : brightness(s); }                // what then counts of a spectrum

bool is_black(Spectrum s) { return max_component(s) <= 0.0; }

// Exactly x where all lanes are x.
float lane_mean(Spectrum s) { return s.x + dot(s - s.x, Spectrum(1.0 / float(LANES))); }

// Four spectra, S0 to S3 of light (lib/stokes.glsl): columns of a matrix, so that sums and differences are written as those of one.
Stokes scaled(Stokes s, Spectrum factor) { return Stokes(s[0] * factor, s[1] * factor, s[2] * factor, s[3] * factor); }
Spectrum scaled(Spectrum s, Spectrum factor) { return s * factor; }
bool is_black(Stokes s) { return is_black(s[0]); }
