// What every pass of the real-time engine reads, in C++ and GLSL: the frame, the views and the geometry
// table. std430: each member is placed so that both languages see the same bytes.
#ifndef HELIODON_PASSES_FRAME_SHARED_H
#define HELIODON_PASSES_FRAME_SHARED_H
#include "shading/language.h"
SHADING_BEGIN

SHADING_CONST uint no_attribute = 0xffffffffu;

// How compact attributes are stored, one 32-bit word a vertex each (realtime/vertex_packing.h).
SHADING_CONST uint geometry_format_compact_vectors = 1u;  // normals and tangents
SHADING_CONST uint geometry_format_compact_texcoord0 = 2u;
SHADING_CONST uint geometry_format_compact_texcoord1 = 4u;
SHADING_CONST uint geometry_format_closed = 8u;  // triangles bound a volume and face out of it: nobody sees their rear
SHADING_CONST uint compact_normal_zero = 0x80008000u;  // vectors of no length: codes that no direction has
SHADING_CONST uint compact_tangent_zero = 0x40008000u;
SHADING_CONST uint compact_tangent_negative = 0x80000000u;  // the bitangent's sign

/// Where one geometry lies in the mega buffers: offsets count 32-bit words (attributes) or indices.
struct GeometryData {
    vec3 bounds_min;
    uint position_offset;
    vec3 bounds_max;
    uint normal_offset;
    uint tangent_offset;
    uint texcoord0_offset;
    uint texcoord1_offset;
    uint color_offset;
    uint first_index;
    uint index_count;  // 0: a hole in the table
    uint format;       // geometry_format_…
    uint padding;
};

/// One camera's frame. A pixel's ray leaves `position` along
/// ray_corner + (x + ½ + jitter.x) ray_dx + (y + ½ + jitter.y) ray_dy, whose component along `forward` is 1.
struct FrameData {
    mat4 world_to_clip;  // jittered; reversed depth, far plane at infinity unless the camera has one
    vec3 position;
    float exposure;  // 1 / (1.2 · 2^EV100)
    vec3 forward;
    float near_m;
    vec3 ray_corner;
    uint width;
    vec3 ray_dx;
    uint height;
    vec3 ray_dy;
    uint sample_index;
    vec2 jitter;
    float texture_gradient_scale;  // 1/√samples for a still picture: each sample covers that share of the pixel
    uint sky_enabled;
    uint instance_count;
    uint light_first;  // lights of this batch
    uint light_count;
    uint batch;  // 0 overwrites and adds emission and sky; later batches only add their lights
    uint aov;    // frame_aov_…
    uint shadow_filter;  // shadow_filter_…
    uint fragment_capacity;
    uint random_seed;
    uint cone_traced;  // 1: indirect light and the sky come from cones through the voxel volume
    uint volume_light;  // of the batch: what it reaches is known by pixel (passes/shadow_volumes); or no_light
    vec2 cone_shift;   // of diffuse_cone() and reflection_cone()
    float cone_share;  // likewise
};

SHADING_CONST uint no_light = 0xffffffffu;

SHADING_CONST uint frame_aov_none = 0u;
SHADING_CONST uint frame_aov_albedo = 1u;
SHADING_CONST uint frame_aov_normal = 2u;
SHADING_CONST uint frame_aov_depth = 3u;
SHADING_CONST uint frame_aov_position = 4u;
SHADING_CONST uint frame_aov_indirect = 5u;
SHADING_CONST uint frame_aov_occlusion = 6u;  // openness
SHADING_CONST uint frame_aov_voxels = 7u;     // radiance of the voxel volume
SHADING_CONST uint frame_aov_opacity = 8u;    // its cover
SHADING_CONST uint frame_aov_illuminance = 9u;  // lux that fall on the surface's side

SHADING_CONST uint shadow_filter_nearest = 0u;  // the texel grid moves between samples and the mean filters
SHADING_CONST uint shadow_filter_percentage_closer = 1u;
// 2: shadow_lookup.glsl's own
SHADING_CONST uint shadow_filter_contact_hardening = 3u;  // as wide as the penumbra of a directional light's disc

SHADING_CONST uint shadow_kind_perspective = 0u;
SHADING_CONST uint shadow_kind_orthographic = 1u;
SHADING_CONST uint shadow_kind_none = 2u;  // no map: a cascade that is not needed

/// One square of the shadow map array. The point seen at normalized device coordinates (u, v) lies at
///   perspective:  origin + w (forward + u axis_u + v axis_v), stored depth near_m / w
///   orthographic: origin + u axis_u + v axis_v + t forward,   stored depth 1 − t / range_m
struct ShadowViewData {
    mat4 world_to_clip;
    vec3 origin;
    uint kind;
    vec3 axis_u;
    float near_m;
    vec3 axis_v;
    float range_m;
    vec3 forward;
    uint layer;
    uint corner_x;  // texels
    uint corner_y;
    uint size;
    uint wider;  // 1: the next view is a wider one of the same light
    float border;  // of a cascade: share of its half width over which wider views take over
    float disc_tangent;  // of the angular radius of the directional light that filters soften; 0: a point
    uint padding0;
    uint padding1;
};

/// What a cull or raster view needs.
struct ViewData {
    mat4 world_to_clip;
};

SHADING_CONST uint draw_list_opaque = 0u;
SHADING_CONST uint draw_list_tested = 1u;   // alpha-masked (and, in shadow views, blended)
SHADING_CONST uint draw_list_blended = 2u;
SHADING_CONST uint draw_lists_per_view = 3u;

/// VkDrawIndexedIndirectCommand
struct DrawCommand {
    uint index_count;
    uint instance_count;
    uint first_index;
    int vertex_offset;
    uint first_instance;
};

SHADING_END
#endif
