// Where wavelengths part a path goes on with the hero alone, which stands for all four (Wilkie et al. 2014, section 3.1, with delta
// events: the others could not have gone this way).
#include "interfaces/medium_optics.glsl"
#include "lib/path.glsl"

#if HAS_DISPERSION
// Once: whoever joins two such paths divides by four.
void make_monochrome(inout Path path) {
    if ((path.flags & PATH_MONOCHROME) != 0u) return;
    path.throughput *= Spectrum(4, 0, 0, 0);
    path.flags |= PATH_MONOCHROME;
}

bool has_one_index(Spectrum ior) { return ior == Spectrum(ior.x); }
void part_at_interface(inout Path path, bool parts) {
    if (parts) make_monochrome(path);
}
void part_where_index_does(inout Path path, uint medium) {
    if (!has_one_index(medium_spectral_ior(medium, path.origin))) make_monochrome(path);
}
bool is_monochrome(Path path) { return (path.flags & PATH_MONOCHROME) != 0u; }
#else
#define has_one_index(ior) true
#define part_at_interface(path, parts)
#define part_where_index_does(path, medium)
#define is_monochrome(path) false
#endif
