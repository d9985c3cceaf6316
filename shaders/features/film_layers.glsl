// What a film has layers for: S1 to S3 beside S0 (features/stokes_images.glsl), or behind all light that which layers of their own
// hold (features/light_layers.glsl), part by part.
#include "features/defaults.glsl"
#include "features/stokes_images.glsl"

#if LIGHT_LAYERS > 0
const uint FILM_LAYERS = 1u + uint(LIGHT_LAYERS);
const uint SPLAT_LAYERS = uint(LIGHT_LAYERS);  // all light is their sum

// What one path from a lamp to the receiver brings, and what several have brought, layer by layer.
struct Brought {
    Received light;
    uint layer;
};
struct Collected { Received layers[LIGHT_LAYERS]; };

bool is_black(Brought b) { return is_black(b.light); }
Brought nothing_brought() { return Brought(Received(0), 0u); }
Collected nothing_collected() {
    Collected c;
    for (int i = 0; i < LIGHT_LAYERS; ++i) c.layers[i] = Received(0);
    return c;
}
// Without an index, which would take the layers out of their registers.
void collect(inout Collected sum, Brought b) {
    for (int i = 0; i < LIGHT_LAYERS; ++i) sum.layers[i] += uint(i) == b.layer ? b.light : Received(0);
}
Collected sum_of(Collected a, Collected b) {
    for (int i = 0; i < LIGHT_LAYERS; ++i) a.layers[i] += b.layers[i];
    return a;
}
Collected difference(Collected a, Collected b) {
    for (int i = 0; i < LIGHT_LAYERS; ++i) a.layers[i] -= b.layers[i];
    return a;
}
Collected scaled(Collected c, Spectrum factor) {
    for (int i = 0; i < LIGHT_LAYERS; ++i) c.layers[i] = scaled(c.layers[i], factor);
    return c;
}
Collected times(Collected c, float factor) { return scaled(c, Spectrum(factor)); }
void add_collected(inout Collected sum, Collected more) { sum = sum_of(sum, more); }

Received film_layer(Collected c, uint layer) {
    if (layer > 0u) return c.layers[layer - 1u];
    Received all = c.layers[0];
    for (int i = 1; i < LIGHT_LAYERS; ++i) all += c.layers[i];
    return all;
}
#define light_of(brought) brought.light
#define splat_layer(brought, stokes) brought.layer

#else
const uint FILM_LAYERS = STOKES_LAYERS;
const uint SPLAT_LAYERS = STOKES_LAYERS;
#define Brought Received
#define Collected Received
#define nothing_brought() Received(0)
#define nothing_collected() Received(0)
#define collect(sum, brought) sum += brought
#define sum_of(a, b) (a + b)
#define difference(a, b) (a - b)
#define times(a, factor) (factor * a)
#define add_collected(sum, more) sum += more
#define film_layer(collected, layer) stokes_layer(collected, layer)
#define light_of(brought) brought
#define splat_layer(brought, stokes) stokes
#endif
