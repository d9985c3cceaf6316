// Images of S0 to S3, where the receiver asks for them: what is brought to it is a Stokes vector instead of its S0, and the film
// has four layers. Backward paths carry a row for each (features/polarization.glsl).
#include "features/defaults.glsl"
#include "features/spectrum.glsl"
#include "lib/stokes.glsl"

#if STOKES_IMAGE
#define Received Stokes
const uint STOKES_LAYERS = 4u;
Spectrum stokes_layer(Stokes s, uint layer) { return s[layer]; }
#else
#define Received Spectrum
const uint STOKES_LAYERS = 1u;
#define stokes_layer(received, layer) received
#endif

// What paths carry of polarization: forward a Stokes vector, backward the row of S0, and for such images those of S1 to S3, in
// the same units.
#if STOKES_IMAGE && !FORWARD
struct Carried { Stokes rows[4]; };
#else
#define Carried Polarization
#endif
