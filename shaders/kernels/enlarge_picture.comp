// Enlarges a developed picture to the window's size without smoothing, one lane a pixel of the window.
// Reads: words of four bytes. Writes: the same. Barrier expected: after the dispatch.
layout(local_size_x = 64) in;
layout(push_constant) uniform Push {
    uint width, height;  // of the window
    uint picture_width, picture_height;
};

layout(scalar, set = 0) readonly buffer Encoded { uint encoded[]; };
layout(scalar, set = 0) writeonly buffer Enlarged { uint enlarged[]; };

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
    enlarged[i] = encoded[at.y * picture_width + at.x];
}
