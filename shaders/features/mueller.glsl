// What events do to polarization, kept beside how they scatter; in scenes without polarization nothing.
#include "features/defaults.glsl"
#include "lib/member_if.glsl"
#include "lib/stokes.glsl"

#if HAS_POLARIZATION
#define keep_mueller(member, matrix) member = matrix
#define no_mueller(member) member = depolarizing()
#else
#define keep_mueller(member, matrix)
#define no_mueller(member)
#endif
