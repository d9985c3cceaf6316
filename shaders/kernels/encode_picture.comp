// Develops a picture for the window, one lane a pixel of the picture.
// Reads: picture, transform. Writes: words of four bytes for the swapchain. Barrier expected: after the dispatch.
layout(local_size_x = 64) in;
layout(push_constant) uniform Push {
    uint pixels;
    uint blue_first;  // order of the bytes: blue, green, red, alpha; else red first
};

#include "view/tone_curves.glsl"

layout(scalar, set = 0) readonly buffer Picture { vec3 picture[]; };
layout(scalar, set = 0) readonly buffer ViewTable { ViewTransform view; };
layout(scalar, set = 0) writeonly buffer Encoded { uint encoded[]; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= pixels) return;
    vec3 color = view_color(view, picture[i]);
    encoded[i] = packUnorm4x8(vec4(blue_first != 0u ? color.bgr : color, 1.0));
}
