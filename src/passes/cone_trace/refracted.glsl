// What comes through a transmissive surface: into the solid, through it, and out on the other side, where the volume knows
// that to be (docs/gi-theory.md).
#ifndef HELIODON_REFRACTED_GLSL
#define HELIODON_REFRACTED_GLSL
#include "passes/common/surface.glsl"
#include "passes/cone_trace/cone_light.glsl"
#include "passes/cone_trace/cone_lobes.glsl"

/// Area × normal of what lies about a place (finest voxels), in faces of a voxel: its six sides on the whole. Surfaces that
/// show both sides alike cancel out, and what one side sees from the front with what the other sees from behind.
vec3 outward_area(vec3 at) {
    const float level = level_holding(at);
    const vec3 first = face_coordinates(at, exp2(level), level);
    vec3 area;
    for (int axis = 0; axis < 3; ++axis) {
        const vec3 positive = first + vec3(0.0f, 0.0f, float(axis) / 3.0f);
        const vec3 negative = positive + vec3(0.5f, 0.0f, 0.0f);
        area[axis] = abs(textureLod(voxel_faces_texture, positive, 0.0f).a) - abs(textureLod(voxel_faces_texture, negative, 0.0f).a);
    }
    return area;
}

/// Share of light that a material's voxels stop, as voxelization has it: at the mean cosine of a diffuse field.
float voxel_cover(Surface surface) {
    const vec3 wo = vec3(sqrt(5.0f) / 3.0f, 0.0f, 2.0f / 3.0f);
    const vec3 through = bsdf_transmission_albedo_prepared(surface, bsdf_prepare(surface, wo));
    return 1.0f - (through.x + through.y + through.z) * (1.0f / 3.0f);
}

/// The longest way through the solid that an instance is, in metres; 0 if its surface does not bound one.
float solid_diagonal(uint instance_index) {
    const InstanceData instance = instance_table[instance_index];
    const GeometryData geometry = geometry_table[instance.geometry];
    if ((geometry.format & geometry_format_closed) == 0u) return 0.0f;
    return length(mat3(instance.object_to_world) * (geometry.bounds_max - geometry.bounds_min));
}

/// Where a ray leaves the solid that it has entered, within `farthest` finest voxels; `cover` of the solid's surface.
/// Interpolated areas of the layers that it crosses add up to the surface's projection to the ray, in steps of a voxel at
/// any angle: `cover` times 1. False, and both results left as they are, where there is no such place.
bool solid_exit(vec3 start, vec3 direction, float farthest, float cover, inout vec3 place, inout vec3 normal) {
    vec3 normals = vec3(0.0f);
    vec4 places = vec4(0.0f);
    for (float t = 0.0f; t < farthest && places.w < cover; t += 1.0f) {
        const vec3 at = start + t * direction;
        const vec3 area = outward_area(at);
        const float leaving = max(dot(area, direction), 0.0f);
        normals += leaving * area;
        places += leaving * vec4(at, 1.0f);
    }
    // What is less than half of a crossing is not one.
    if (places.w < 0.5f * cover || places.w == 0.0f) return false;
    place = places.xyz / places.w;
    normal = normalize(normals);
    return true;
}

struct Refracted {
    Cone cone;      // in the world; weight: its share
    vec3 origin;    // in finest voxels
    vec3 middle;    // of the way through the solid, likewise
    float trapped;  // share that is reflected within: the solid gives it back from and to everywhere
    vec3 tint;      // by the surface on the other side
};

/// The cone that leaves through a surface of normal −z of `frame`, after `entered`.
void leave(Frame frame, BsdfLobes lobes, Cone entered, inout Refracted result) {
    const vec3 inward = to_local(frame, -entered.direction);
    const float reflected = fresnel_dielectric(inward.z, 1.0f / lobes.eta);
    result.trapped = entered.weight;
    result.cone.weight = 0.0f;
    Cone cone;
    if (inward.z <= 0.0f || reflected >= 1.0f || !refraction_cone(inward, lobes.alpha, 1.0f / lobes.eta, cone)) return;
    // η² cos θ dω stays (étendue), and the blur of both surfaces adds up, no wider than to the horizon.
    const float spread = lobes.eta * lobes.eta * inward.z / max(-cone.direction.z, 1.0e-6f);
    const float slope = length(cone.direction.xy);
    const float widest = slope > 0.0f ? one_minus_cos_from_tan(abs(cone.direction.z) / slope) : 1.0f;
    cone.one_minus_cos = min(cone.one_minus_cos + spread * entered.one_minus_cos, widest);
    cone.tan_half_angle = tan_from_one_minus_cos(cone.one_minus_cos);
    cone.direction = to_world(frame, cone.direction);
    cone.weight = entered.weight * (1.0f - reflected);
    result.trapped = entered.weight * reflected;
    result.cone = cone;
}

/// `diagonal_m`: solid_diagonal(). Where the volume knows no other side of a solid, it is taken for a thin pane.
Refracted refracted(SurfacePoint point, vec3 wo, BsdfLobes lobes, float diagonal_m) {
    Refracted result;
    result.trapped = 0.0f;
    result.tint = vec3(1.0f);
    result.origin = cone_origin(point.position, -point.geometric);
    result.middle = result.origin;
    if (passes_sheet(point.material.surface)) {  // as the reflection, on the other side
        result.cone = specular_cone(wo, lobes.alpha);
        result.cone.direction.z = -result.cone.direction.z;
        result.cone.direction = to_world(point.frame, result.cone.direction);
        return result;
    }
    if (!refraction_cone(wo, lobes.alpha, lobes.eta, result.cone)) return result;  // weight 0
    result.cone.direction = to_world(point.frame, result.cone.direction);
    if (diagonal_m == 0.0f || lobes.eta <= 1.0f) return result;
    result.tint = lobes.transmission_color;
    const vec3 start = to_lattice(point.position);
    vec3 normal = -point.frame.normal;
    const float cover = voxel_cover(point.material.surface);
    if (solid_exit(start, result.cone.direction, diagonal_m / volume.voxel_m, cover, result.origin, normal)) {
        result.middle = 0.5f * (start + result.origin);
        if (is_extended(point.material.surface))  // Beer & Lambert
            result.tint *= exp(-point.material.surface.absorption * (distance(start, result.origin) * volume.voxel_m));
    }
    leave(frame_from_normal(-normal), lobes, result.cone, result);
    return result;
}

/// One of six even cones along the axes that fill the sphere.
const uint around_cones = 6u;
Cone around_cone(uint index) {
    Cone cone;
    cone.direction = vec3(0.0f);
    cone.direction[index >> 1u] = (index & 1u) == 0u ? 1.0f : -1.0f;
    cone.one_minus_cos = 2.0f / float(around_cones);  // solid angle / 2π
    cone.tan_half_angle = tan_from_one_minus_cos(cone.one_minus_cos);
    cone.weight = 1.0f / float(around_cones);
    return cone;
}

/// Its cones: the one that leaves, and those for what is trapped. `origin` in finest voxels.
const uint refracted_cones = 1u + around_cones;
Cone refracted_cone(Refracted through, uint index, out vec3 origin) {
    origin = index == 0u ? through.origin : through.middle;
    if (index == 0u) return through.cone;
    Cone cone = around_cone(index - 1u);
    cone.weight *= through.trapped;
    return cone;
}

#endif
