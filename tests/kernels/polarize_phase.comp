// What one phase function does to polarization, for pairs of directions.
#include "interfaces/phase_function.glsl"
layout(local_size_x = 64) in;

struct Query { vec3 from, to; uint event; };
layout(scalar, set = 0) readonly buffer Queries { Query queries[]; };
struct Matrix { vec3 from, to; Spectrum m[16]; };
layout(scalar, set = 0) writeonly buffer Muellers { Matrix muellers[]; };
layout(push_constant) uniform Push { uint asked, phase; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= asked) return;
    Mueller m = phase_mueller(phase, queries[i].from, queries[i].to);
    muellers[i].from = m.from, muellers[i].to = m.to;
    for (int k = 0; k < 4; ++k) {
        Stokes unit = Stokes(0);
        unit[k] = Spectrum(1);
        Stokes column = apply_mueller(unit, m, false);
        for (int row = 0; row < 4; ++row) muellers[i].m[4 * row + k] = column[row];
    }
}
