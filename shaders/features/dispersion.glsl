// Where wavelengths part, at a dispersive index or a grating, a path goes on with one of the four alone, its hero, which stands for all (Wilkie et al. 2014, section 3.1,
// with delta events: the others could not have gone this way). Which one each path draws on its own, or a pass would have one hue:
// pixels keep theirs, counted from the first wavelength of the pass, which goes round (host/spectra/wavelengths.h).
//
// Paths that part wavelengths carry four times their hero. Where two of them meet, their heroes are the same one time in four, and
// what they bring is 16 times that of the hero: right on average, without a case of its own.
#include "interfaces/medium_optics.glsl"
#include "lib/light_vertices.glsl"
#include "lib/path.glsl"

#if HAS_DISPERSION
void follow_hero(Path path) { hero = (path.flags >> PATH_HERO_SHIFT) & 3u; }
void start_hero(inout Path path, uint random) {
    path.flags |= (random & 3u) << PATH_HERO_SHIFT;
    follow_hero(path);
}

void make_monochrome(inout Path path) {
    if ((path.flags & PATH_MONOCHROME) != 0u) return;
    Spectrum share = Spectrum(0);
    share[hero] = 4.0;
    path.throughput *= share;
    path.flags |= PATH_MONOCHROME;
}

bool has_one_index(Spectrum ior) { return ior == Spectrum(ior.x); }
void part_at_interface(inout Path path, bool parts) {
    if (parts) make_monochrome(path);
}
void part_where_index_does(inout Path path, uint medium) {
    if (!has_one_index(medium_spectral_ior(medium, path.origin))) make_monochrome(path);
}

// Forward vertices whose path has parted its wavelengths bring nothing to a path with another hero.
bool shares_hero(Path path, LightVertex y) { return !is_black(path.throughput * y.throughput); }

// At a forward vertex its own path's hero counts; the other hero is returned.
uint take_hero_of(LightVertex y) {
    uint other = hero;
    for (uint lane = 0u; lane < 4u; ++lane)
        if (max_component(y.throughput) == y.throughput[lane] && dot(y.throughput, Spectrum(1)) == y.throughput[lane]) hero = lane;
    return other;
}
void take_hero(uint lane) { hero = lane; }
#else
#define follow_hero(path)
#define start_hero(path, random)
#define has_one_index(ior) true
#define part_at_interface(path, parts)
#define part_where_index_does(path, medium)
#define shares_hero(path, y) true
#define take_hero_of(y) 0u
#define take_hero(lane)
#endif
