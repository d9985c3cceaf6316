// Where forward rays alone bring light (--algorithm forward): whatever reaches the receiver from a surface that is not perfectly
// smooth.
#include "interfaces/surface_optics.glsl"
#include "lib/path.glsl"

#if FORWARD_ONLY
bool forward_brings(Path path) { return (path.flags & PATH_STARTS) != 0u; }
// Does the path end at this event, since forward rays bring all that is behind?
bool leaves_rest(inout Path path, uint event) {
    if (forward_brings(path) && (event & EVENT_DELTA) == 0u) return true;
    if ((event & EVENT_STRAIGHT) == 0u) path.flags &= ~PATH_STARTS;
    return false;
}
#else
#define forward_brings(path) false
#define leaves_rest(path, event) false
#endif
