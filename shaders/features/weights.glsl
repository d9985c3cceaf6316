// What a path carries for the weights of the ways to make it (features/mis.glsl).
//
// What media that scatter let pass without scattering counts in them: ways that sample free paths need it, connections do not. It is
// that of an average lane (interfaces/medium_optics.glsl).
#include "interfaces/medium_optics.glsl"
#include "lib/path.glsl"

// The weight of a way to make a path, `others` being the density of all others relative to its own. With a single other in
// backward rays the power heuristic (Veach 1997, section 9.2.4), else the balance heuristic.
float mis_weight(float others) { return 1.0 / (1.0 + (BIDIRECTIONAL == 1 ? others : others * others)); }

#if BIDIRECTIONAL
void start_weights(inout Path path, float vcm, float vc) { path.vcm = vcm, path.vc = vc, path.pending = 0.0; }
// As update_mis() does where light is refracted.
void forget_weights(inout Path path) {
    path.vc += path.pending;
    path.pending = path.vcm = 0.0;
    path.flags |= PATH_AFTER_NARROW;
}
#else
#define start_weights(path, vcm, vc)
#define forget_weights(path)
#endif

#if HAS_SCATTERING
void start_passage(inout Path path) { path.passage = 1.0; }
void lessen_passage(inout Path path, float passage) { path.passage *= passage; }
float passage_of(Path path) { return path.passage; }

// Weighs a connection. `others`: as far as they do not pass scattering media along it, which all of them must and it need not.
void weigh(inout ShadowRay ray, float others) { ray.others = others; }
void weigh_alone(inout ShadowRay ray) { ray.others = 0.0; }
void lessen_others(inout ShadowRay ray, float passage) {
    if (medium_scatters(ray.around.medium)) ray.others *= passage;
}
#else
#define start_passage(path)
#define lessen_passage(path, passage)
#define passage_of(path) 1.0
#define weigh_alone(ray)
#define weigh(ray, others) ray.contribution *= mis_weight(others)
#define lessen_others(ray, passage)
#endif

// Nothing samples or connects the next event from the one before.
void forget_event(inout Path path) {
    path.pdf = 0.0;
    path.reference = path.origin;
    start_passage(path);
    forget_weights(path);
    path.flags &= ~(PATH_STARTS | PATH_PARALLEL);
}

// The density of others that needs no passage, and what the ray brings where nothing has stopped it.
#if BEAMS
void weigh_apart(inout ShadowRay ray, float others) { ray.others_apart = others; }
Spectrum weighed(ShadowRay ray) { return ray.contribution * mis_weight(ray.others + ray.others_apart); }
#elif HAS_SCATTERING
#define weigh_apart(ray, others)
Spectrum weighed(ShadowRay ray) { return ray.contribution * mis_weight(ray.others); }
#else
#define weigh_apart(ray, others)
#define weighed(ray) ray.contribution
#endif
