// Develops a picture for the window, one lane a pixel of the window; a smaller picture is enlarged without smoothing.
// Reads: picture, transform. Writes: words of four bytes for the swapchain. Barrier expected: after the dispatch.
layout(local_size_x = 64) in;
layout(push_constant) uniform Push {
    uint width, height;                  // of the window
    uint picture_width, picture_height;
    uint blue_first;                     // order of the bytes: blue, green, red, alpha; else red first
};

#include "view/tone_curves.glsl"

layout(scalar, set = 0) readonly buffer Picture { vec3 picture[]; };
layout(scalar, set = 0) readonly buffer ViewTable { ViewTransform view; };
layout(scalar, set = 0) writeonly buffer Shown { uint shown[]; };

// Row and column without integer divisions, which take longer than all else on CPUs.
uvec2 window_pixel(uint i) {
    uint y = uint(float(i) / float(width));
    int x = int(i - y * width);  // the quotient may be rounded over the end of the row
    if (x < 0) return uvec2(x + int(width), y - 1u);
    return x < int(width) ? uvec2(x, y) : uvec2(x - int(width), y + 1u);
}

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= width * height) return;
    vec2 size = vec2(picture_width, picture_height);
    uvec2 at = uvec2(min((vec2(window_pixel(i)) + 0.5) * (size / vec2(width, height)), size - 1.0));
    vec3 color = view_color(view, picture[at.y * picture_width + at.x]);
    shown[i] = packUnorm4x8(vec4(blue_first != 0u ? color.bgr : color, 1.0));
}
