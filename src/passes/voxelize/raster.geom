#version 460
#extension GL_GOOGLE_include_directive : require
// Projects each triangle along its dominant axis so that a pixel is a column of voxels, and, where the hardware does not
// find every pixel that the triangle touches, dilates it (Hasselgren, Akenine-Möller & Ohlsson 2005, "Conservative
// Rasterization", the hull of the pixel-sized squares about its corners).
#include "passes/voxelize/voxel_ranges.glsl"
#include "passes/voxelize/voxel_triangle.glsl"

layout(triangles) in;
layout(triangle_strip, max_vertices = 9) out;
layout(location = 0) flat out uvec2 triangle_of;  // instance, primitive
layout(location = 1) flat out vec3 corner0;
layout(location = 2) flat out vec3 corner1;
layout(location = 3) flat out vec3 corner2;

void emit(VoxelTriangle triangle, vec2 column) {
    triangle_of = uvec2(triangle.instance, triangle.primitive);
    corner0 = triangle.p0;
    corner1 = triangle.p1;
    corner2 = triangle.p2;
    const vec2 at = column * (2.0f / float(push.grid.size)) - 1.0f;
    gl_Position = vec4(at.x, -at.y, 0.5f, 1.0f);  // the viewport's y points up, rows count down
    EmitVertex();
}

/// The corner of the square that lies farthest along `direction`.
vec2 square_corner(vec2 direction) { return vec2(direction.x >= 0.0f ? 1.0f : -1.0f, direction.y >= 0.0f ? 1.0f : -1.0f); }
vec2 outward(vec2 a, vec2 b, float turn) { return vec2(b.y - a.y, a.x - b.x) * turn; }

void emit_dilated(VoxelTriangle triangle, vec2 corners[3]) {
    const vec2 low = min(corners[0], min(corners[1], corners[2])) - push.dilation_px;
    const vec2 high = max(corners[0], max(corners[1], corners[2])) + push.dilation_px;
    if (all(lessThan(high - low, vec2(2.0f + 2.0f * push.dilation_px)))) {  // too small for its edges' directions to matter
        emit(triangle, low);
        emit(triangle, vec2(high.x, low.y));
        emit(triangle, vec2(low.x, high.y));
        emit(triangle, high);
        return;
    }
    const float turn = determinant(mat2(corners[1] - corners[0], corners[2] - corners[0])) < 0.0f ? -1.0f : 1.0f;
    vec2 hull[9];
    for (int i = 0; i < 3; ++i) {
        const vec2 before = square_corner(outward(corners[(i + 2) % 3], corners[i], turn));
        const vec2 after = square_corner(outward(corners[i], corners[(i + 1) % 3], turn));
        // Opposite corners have a third between them: the next one in the hull's direction of rotation.
        const vec2 between = before == -after ? turn * vec2(-before.y, before.x) : before;
        hull[3 * i] = corners[i] + push.dilation_px * before;
        hull[3 * i + 1] = corners[i] + push.dilation_px * between;
        hull[3 * i + 2] = corners[i] + push.dilation_px * after;
    }
    emit(triangle, hull[0]);
    for (int i = 1; i < 5; ++i) {
        emit(triangle, hull[i]);
        emit(triangle, hull[9 - i]);
    }
}

void main() {
    VoxelTriangle triangle;
    const uint number = uint(gl_PrimitiveIDIn);
    const TriangleRange range = range_of(number, push.range_count);
    if (!load_triangle(range.instance, number - range.first_triangle, triangle)) return;
    const int axis = dominant_axis(triangle.normal);
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    const vec2 corners[3] = vec2[3](vec2(triangle.p0[u], triangle.p0[v]), vec2(triangle.p1[u], triangle.p1[v]),
                                    vec2(triangle.p2[u], triangle.p2[v]));
    if (push.dilation_px > 0.0f) emit_dilated(triangle, corners);
    else for (int i = 0; i < 3; ++i) emit(triangle, corners[i]);
    EndPrimitive();
}
