// Which pixels trace cones for those about them, and which of four a pixel lies between.
#ifndef HELIODON_TRACED_PIXELS_GLSL
#define HELIODON_TRACED_PIXELS_GLSL

layout(constant_id = 1) const int spacing = 1;  // of traced pixels: 1, 2 or 4

/// The traced pixel of a cell of spacing × spacing: over the samples of a picture each of them in turn, by the first binary
/// digits of Sobol's sequence in two dimensions (Sobol 1967), so that any run of samples is spread over the cell.
ivec2 traced_pixel(ivec2 cell, uint sample_index, ivec2 picture_size) {
    const int x = int(bitfieldReverse(sample_index) >> 30u);
    const int y = 2 * (bitCount(sample_index & 15u) & 1) + (bitCount(sample_index & 10u) & 1);
    return min(cell * spacing + ivec2(x, y) * spacing / 4, picture_size - 1);
}

/// The four cells about a pixel, and its bilinear shares of them.
struct AboutPixel {
    ivec2 cells[4];
    vec4 shares;
};
AboutPixel about_pixel(ivec2 pixel, uint sample_index, ivec2 picture_size) {
    const vec2 at = vec2(pixel - traced_pixel(ivec2(0), sample_index, ivec2(spacing))) / float(spacing);
    const ivec2 last = (picture_size - 1) / spacing;
    AboutPixel result;
    for (int i = 0; i < 4; ++i) {
        const ivec2 corner = ivec2(i & 1, i >> 1);
        const vec2 share = 1.0f - abs(at - floor(at) - vec2(corner));
        result.cells[i] = clamp(ivec2(floor(at)) + corner, ivec2(0), last);
        result.shares[i] = share.x * share.y;
    }
    return result;
}

#endif
