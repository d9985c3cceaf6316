// A spectral quantity along a ray: one lane per colour channel, linear Rec.709.
#define Spectrum vec3

// A spectral parameter of a record, resolved by the host from any spectral value of the scene format.
struct SpectrumRef {
    vec4 data;  // xyz: linear Rec.709; w: reserved for the tabulated spectrum
};

Spectrum spectrum_value(SpectrumRef ref) { return ref.data.xyz; }
// Multiplies a parameter by a color, as textures do.
void scale_spectrum(inout SpectrumRef ref, vec3 color) { ref.data.xyz *= color; }

// CIE luminance Y of linear Rec.709 (ITU-R BT.709-6).
float luminance(Spectrum s) { return dot(s, vec3(0.2126, 0.7152, 0.0722)); }
float max_component(Spectrum s) { return max(s.x, max(s.y, s.z)); }
float mean_component(Spectrum s) { return (s.x + s.y + s.z) * (1.0 / 3.0); }
bool is_black(Spectrum s) { return max_component(s) <= 0.0; }
