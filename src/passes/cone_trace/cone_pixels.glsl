// The surfaces of a picture's pixels, as the passes that trace their cones read them.
#ifndef HELIODON_CONE_PIXELS_GLSL
#define HELIODON_CONE_PIXELS_GLSL
#include "passes/common/frame_shared.h"
#include "passes/cone_trace/cone_surface.glsl"
#include "passes/cone_trace/volume_data.glsl"
#include "shading/lobe_cone.h"

layout(set = 0, binding = 8, std140) uniform Frame_ { FrameData frame; };
layout(set = 0, binding = 11, std430) readonly buffer ShadingTables { float shading_tables[]; };
layout(set = 0, binding = 12) uniform usampler2D surface_places;
layout(set = 0, binding = 18) uniform usampler2D surface_albedos;
layout(set = 0, binding = 19) uniform usampler2D surface_lobes;
float shading_table(uint index) { return shading_tables[index]; }

ConePlace place_at(ivec2 pixel) { return unpack_place(texelFetch(surface_places, pixel, 0)); }
ConeLobes lobes_at(ivec2 pixel) { return unpack_lobes(texelFetch(surface_albedos, pixel, 0), texelFetch(surface_lobes, pixel, 0).x); }
/// Of length 1 along the view.
vec3 view_ray(ivec2 pixel) {
    const vec2 at = vec2(pixel) + 0.5f + frame.jitter;
    return frame.ray_corner + frame.ray_dx * at.x + frame.ray_dy * at.y;
}
vec3 position_at(ivec2 pixel, float depth_m) { return frame.position + depth_m * view_ray(pixel); }
/// The viewer's direction about a normal: in its frame.
vec3 viewer(ivec2 pixel, vec3 normal) { return to_local(frame_from_normal(normal), -normalize(view_ray(pixel))); }

/// Where in their cells a pixel's cones stand. Narrow ones of one shift for all pixels would show as bands what the
/// samples miss of small lamps: in squares of 8×8 each pixel has a shift of its own, by powers of the plastic number's
/// inverse as samples have theirs.
vec2 cone_shift_at(ivec2 pixel) {
    if (frame.cone_share >= 1.0f) return frame.cone_shift;  // a live picture in motion stays calm
    const vec3 powers = vec3(0.7548776662466927f, 0.5698402909980532f, 0.4301597090019468f);
    return fract(frame.cone_shift + powers.xy * float(pixel.x & 7) + powers.yz * float(pixel.y & 7));
}

/// As half floats hold it.
vec3 in_volume_unit(vec3 radiance) { return min(radiance / volume.radiance_unit, vec3(65504.0f)); }

#endif
