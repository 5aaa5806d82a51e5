// A triangle of the scene in a view: projected, snapped to sub-pixels, and its pixels by edge functions
// (Pineda 1988, "A Parallel Algorithm for Polygon Rasterization") under Vulkan's rules: a pixel is covered where its
// centre is, and a centre on an edge belongs to the triangle whose top or left edge it is. Whoever draws a triangle
// computes the same bits, so that neighbours leave no gap.
#ifndef HELIODON_RASTER_TRIANGLE_GLSL
#define HELIODON_RASTER_TRIANGLE_GLSL
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_EXT_shader_atomic_int64 : require
#include "passes/common/alpha.glsl"
#include "passes/voxelize/voxel_ranges.glsl"
#include "passes/compute_raster/compute_raster_shared.h"

layout(constant_id = 0) const bool keeps_slope = false;    // in the key's low half, instead of the triangle
layout(constant_id = 1) const bool tests_opacity = false;  // some material is alpha-masked or blended
layout(set = 0, binding = 8, std430) readonly buffer Views { RasterView views[]; };
/// A pixel's nearest: its depth's bits in the high half; 0 where nothing stands.
layout(set = 0, binding = 13, std430) buffer Keys { uint64_t keys[]; };
layout(set = 0, binding = 14, std430) buffer Strips { RasterStrips strips; uvec2 strip[]; };
layout(set = 0, binding = 17, std430) buffer LargeTriangles { WindowTriangle large[]; };
layout(push_constant) uniform Push { ComputeRasterConstants push; };

struct RasterTriangle {
    uint number;
    uint instance;
    uvec3 index;
    vec4 world[3];
    vec4 clip[3];
    bool tested;
};

vec4 transformed(mat4 matrix, vec4 v) {
    precise vec4 sum = matrix[0] * v.x + matrix[1] * v.y + matrix[2] * v.z + matrix[3] * v.w;
    return sum;
}

RasterTriangle load_triangle(uint number) {
    RasterTriangle triangle;
    const TriangleRange range = range_of(number, push.range_count);
    const InstanceData instance = instance_table[range.instance];
    const GeometryData geometry = geometry_table[instance.geometry];
    triangle.number = number;
    triangle.instance = range.instance;
    const uint first = geometry.first_index + 3u * (number - range.first_triangle);
    triangle.index = uvec3(index_table[first], index_table[first + 1u], index_table[first + 2u]);
    for (int i = 0; i < 3; ++i)
        triangle.world[i] = transformed(instance.object_to_world,
                                        vec4(fetch_vec3(geometry.position_offset, triangle.index[i]), 1.0f));
    const uint tested_flags = material_flag_alpha_mask | material_flag_alpha_blend;
    triangle.tested = tests_opacity && (material_table[instance.material].flags & tested_flags) != 0u;
    return triangle;
}

void project(inout RasterTriangle triangle, RasterView view) {
    for (int i = 0; i < 3; ++i) triangle.clip[i] = transformed(view.world_to_clip, triangle.world[i]);
}

/// The planes that a corner is outside of, a bit each: those of the view …
uint outside_view(vec4 p) {
    return uint(p.x > p.w) | uint(p.x < -p.w) << 1 | uint(p.y > p.w) << 2 | uint(p.y < -p.w) << 3 | uint(p.z > p.w) << 4 |
           uint(p.z < 0.0f) << 5;
}
/// … and those that triangles are clipped by: near (depth is reversed), and the guard band's.
const int clip_planes = 5;
float clip_distance(vec4 p, int plane, float guard) {
    switch (plane) {
        case 0: return p.w - p.z;
        case 1: return guard * p.w - p.x;
        case 2: return guard * p.w + p.x;
        case 3: return guard * p.w - p.y;
        default: return guard * p.w + p.y;
    }
}
uint outside_clip(vec4 p, float guard) {
    uint planes = 0u;
    for (int plane = 0; plane < clip_planes; ++plane) planes |= uint(clip_distance(p, plane, guard) < 0.0f) << plane;
    return planes;
}

vec3 window_position(vec4 clip, RasterView view) {
    precise vec3 position = clip.xyz / clip.w;
    position.xy = (position.xy * vec2(0.5f, -0.5f) + 0.5f) * vec2(view.width, view.height);
    return position;
}

/// False where it covers no pixel's centre for certain.
bool to_window(vec4 c0, vec4 c1, vec4 c2, RasterView view, inout WindowTriangle triangle) {
    const vec3 w0 = window_position(c0, view);
    vec3 w1 = window_position(c1, view);
    vec3 w2 = window_position(c2, view);
    const float scale = float(raster_subpixels);
    triangle.a = ivec2(roundEven(w0.xy * scale));
    triangle.b = ivec2(roundEven(w1.xy * scale));
    triangle.c = ivec2(roundEven(w2.xy * scale));
    // The first centre not before the box, the last one not after it.
    const int half_pixel = raster_subpixels / 2;
    const ivec2 low = min(triangle.a, min(triangle.b, triangle.c)) + (half_pixel - 1);
    const ivec2 high = max(triangle.a, max(triangle.b, triangle.c)) - half_pixel;
    triangle.low = max(ivec2(low.x >> 8, low.y >> 8), ivec2(0));
    triangle.high = min(ivec2(high.x >> 8, high.y >> 8), ivec2(view.width, view.height) - 1);
    if (any(greaterThan(triangle.low, triangle.high))) return false;
    const ivec2 ab = triangle.b - triangle.a;
    const ivec2 ac = triangle.c - triangle.a;
    int64_t twice_area = int64_t(ab.x) * int64_t(ac.y) - int64_t(ab.y) * int64_t(ac.x);
    if (twice_area == 0l) return false;
    vec2 b = vec2(ab);
    vec2 c = vec2(ac);
    if (twice_area < 0l) {
        twice_area = -twice_area;
        const ivec2 corner = triangle.b;
        triangle.b = triangle.c;
        triangle.c = corner;
        b = vec2(ac);
        c = vec2(ab);
        triangle.depth = vec3(w0.z, w2.z, w1.z);
    } else {
        triangle.depth = vec3(w0.z, w1.z, w2.z);
    }
    const float rise_b = triangle.depth.y - triangle.depth.x;
    const float rise_c = triangle.depth.z - triangle.depth.x;
    triangle.slope = vec2(rise_b * c.y - rise_c * b.y, rise_c * b.x - rise_b * c.x) * (scale / float(twice_area));
    return true;
}

/// Not negative on the inner side of an edge, and on it where it is a top or left edge.
struct Edge {
    int64_t at;      // a pixel's centre
    int64_t step_x;  // to the next pixel
    int64_t step_y;
};
Edge edge_at(ivec2 a, ivec2 b, ivec2 pixel) {
    const ivec2 along = b - a;
    const ivec2 from = pixel * raster_subpixels + raster_subpixels / 2 - a;
    const bool top_left = along.y < 0 || (along.y == 0 && along.x > 0);
    Edge edge;
    edge.at = int64_t(along.x) * int64_t(from.y) - int64_t(along.y) * int64_t(from.x) - (top_left ? 0l : 1l);
    edge.step_x = -int64_t(along.y) * int64_t(raster_subpixels);
    edge.step_y = int64_t(along.x) * int64_t(raster_subpixels);
    return edge;
}

/// Barycentric coordinates of the triangle where the view's ray through `position` (pixels) meets it: Olano & Greer
/// 1997, "Triangle Scan Conversion using 2D Homogeneous Coordinates", eq. 4.
vec3 barycentric_at(RasterTriangle triangle, RasterView view, vec2 position) {
    const vec3 at = vec3((position * 2.0f / vec2(view.width, view.height) - 1.0f) * vec2(1.0f, -1.0f), 1.0f);
    const vec3 v0 = triangle.clip[0].xyw;
    const vec3 v1 = triangle.clip[1].xyw;
    const vec3 v2 = triangle.clip[2].xyw;
    const vec3 weights = vec3(dot(cross(v1, v2), at), dot(cross(v2, v0), at), dot(cross(v0, v1), at));
    return weights / (weights.x + weights.y + weights.z);
}

/// Whether the surface is there: masked parts by their cutoff, blended parts with a chance equal to their opacity
/// (passes/shadow/shadow_tested.frag).
bool is_there(RasterTriangle triangle, RasterView view, ivec2 pixel) {
    const InstanceData instance = instance_table[triangle.instance];
    const GeometryData geometry = geometry_table[instance.geometry];
    const MaterialData material = material_table[instance.material];
    const uint set_index = material.base_color_texture.texcoord;
    const mat3x2 texcoords = mat3x2(fetch_texcoord(geometry, set_index, triangle.index.x),
                                    fetch_texcoord(geometry, set_index, triangle.index.y),
                                    fetch_texcoord(geometry, set_index, triangle.index.z));
    const vec2 center = vec2(pixel) + 0.5f;
    const vec3 here = barycentric_at(triangle, view, center);
    const vec2 texcoord = texcoords * here;
    float vertex_alpha = 1.0f;
    if (geometry.color_offset != no_attribute)
        for (int i = 0; i < 3; ++i)
            vertex_alpha += here[i] * (fetch_vec4(geometry.color_offset, triangle.index[i]).a - 1.0f);
    const vec2 texcoord_dx = texcoords * barycentric_at(triangle, view, center + vec2(1.0f, 0.0f)) - texcoord;
    const vec2 texcoord_dy = texcoords * barycentric_at(triangle, view, center + vec2(0.0f, 1.0f)) - texcoord;
    float opacity = surface_opacity_within(material, texcoord, texcoord_dx, texcoord_dy, vertex_alpha);
    if (material.model == material_model_thin) {
        const vec3 normal = cross(triangle.world[1].xyz - triangle.world[0].xyz, triangle.world[2].xyz - triangle.world[0].xyz);
        const vec2 at = (center * 2.0f / vec2(view.width, view.height) - 1.0f) * vec2(1.0f, -1.0f);
        opacity = pane_cover(material, view.world_to_clip, at, normal);
    }
    if ((material.flags & material_flag_alpha_blend) == 0u) return opacity >= material.alpha_cutoff;
    const uvec2 texel = uvec2(pixel) + uvec2(view.corner_x, view.corner_y);
    return unit_interval(alpha_seed(texel, triangle.instance, push.random_seed + view.number)) < opacity;
}

/// A covered pixel. `triangle` is looked at where opacity counts.
void draw(RasterTriangle triangle, WindowTriangle window, RasterView view, ivec2 pixel) {
    const vec2 from = vec2(pixel * raster_subpixels + raster_subpixels / 2 - window.a) * (1.0f / float(raster_subpixels));
    const float lowest = min(window.depth.x, min(window.depth.y, window.depth.z));
    const float highest = max(window.depth.x, max(window.depth.y, window.depth.z));
    const float depth = clamp(window.depth.x + dot(window.slope, from), lowest, highest);
    if (!(depth > 0.0f)) return;  // beyond the far plane
    if (tests_opacity && triangle.tested && !is_there(triangle, view, pixel)) return;
    uint low = ~window.number;  // of what lies in one plane the first is seen
    if (keeps_slope) low = packHalf2x16(clamp(window.slope * (1.0f / depth), vec2(-60000.0f), vec2(60000.0f)));
    const uint place = view.first_key + uint(pixel.y) * view.width + uint(pixel.x);
    atomicMax(keys[place], packUint2x32(uvec2(low, floatBitsToUint(depth))));
}

/// A triangle that one invocation draws.
void draw_box(RasterTriangle triangle, WindowTriangle window, RasterView view) {
    Edge ab = edge_at(window.a, window.b, window.low);
    Edge bc = edge_at(window.b, window.c, window.low);
    Edge ca = edge_at(window.c, window.a, window.low);
    for (int y = window.low.y; y <= window.high.y; ++y) {
        int64_t e0 = ab.at;
        int64_t e1 = bc.at;
        int64_t e2 = ca.at;
        for (int x = window.low.x; x <= window.high.x; ++x) {
            if ((e0 | e1 | e2) >= 0l) draw(triangle, window, view, ivec2(x, y));
            e0 += ab.step_x;
            e1 += bc.step_x;
            e2 += ca.step_x;
        }
        ab.at += ab.step_y;
        bc.at += bc.step_y;
        ca.at += ca.step_y;
    }
}

const uint place_nowhere = 0u;
const uint place_small = 1u;    // one invocation draws it; `window` is known
const uint place_large = 2u;    // a workgroup does; `window` is known
const uint place_clipped = 3u;  // a workgroup does, after clipping

/// Projects the triangle, and says what is to be done with it.
uint place_in(RasterView view, inout RasterTriangle triangle, inout WindowTriangle window) {
    window.number = triangle.number;
    project(triangle, view);
    if ((outside_view(triangle.clip[0]) & outside_view(triangle.clip[1]) & outside_view(triangle.clip[2])) != 0u)
        return place_nowhere;
    if ((outside_clip(triangle.clip[0], view.guard) | outside_clip(triangle.clip[1], view.guard) |
         outside_clip(triangle.clip[2], view.guard)) != 0u)
        return place_clipped;
    if (!to_window(triangle.clip[0], triangle.clip[1], triangle.clip[2], view, window)) return place_nowhere;
    const ivec2 size = window.high - window.low + 1;
    return size.x * size.y <= raster_small_pixels ? place_small : place_large;
}

#endif
