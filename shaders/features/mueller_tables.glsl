// The class `mueller` with tables of matrices (lib/mueller_table.glsl), where a scene has such. Both sides are alike: from behind,
// directions are turned about an axis in the surface, so that what is handed stays so; turned twice they are as before.
#ifndef ABSENT_mueller_file
#include "lib/mueller_table.glsl"

bool mueller_is_table(MuellerSheet r) { return r.file.index != NO_RECORD; }

vec3 mueller_upright(vec3 w, bool below) { return below ? vec3(w.x, -w.yz) : w; }

Mueller mueller_of_table(MuellerSheet r, vec3 from, vec3 to) {
    bool below = from.z < 0.0;
    Mueller m = mueller_table_matrix(mueller_tables[r.file.index], mueller_upright(from, below), mueller_upright(to, below));
    m.from = m.to = mueller_upright(m.from, below);
    return m;
}

SurfacePair mueller_pair_of_table(MuellerSheet r, bool importance, vec3 wo, vec3 wi) {
    bool below = wo.z < 0.0;
    return mueller_table_pair(mueller_tables[r.file.index], importance, mueller_upright(wo, below), mueller_upright(wi, below));
}

BsdfSample mueller_sample_of_table(MuellerSheet r, vec3 wo, vec3 u) {
    bool below = wo.z < 0.0;
    BsdfSample s = mueller_table_sample(mueller_tables[r.file.index], mueller_upright(wo, below), u);
    s.wi = mueller_upright(s.wi, below);
    return s;
}
#else
#define mueller_is_table(r) false
#define mueller_of_table(r, from, to) depolarizing()
#define mueller_pair_of_table(r, importance, wo, wi) no_surface_pair()
#define mueller_sample_of_table(r, wo, u) no_bsdf_sample()
#endif
