#version 460
#extension GL_GOOGLE_include_directive : require
// What the voxels' faces to one side reflect of one batch of lights, with their shadows.
#include "passes/common/light_visibility.glsl"
#include "passes/common/hash.glsl"
#include "passes/inject/face_lobe.glsl"
#include "passes/inject/lit_faces.glsl"
#include "passes/light_grid/light_choice.glsl"
#include "shading/environment.h"
#include "passes/common/luminaires.glsl"

layout(set = 0, binding = 11, std430) readonly buffer ShadingTables { float shading_tables[]; };
float shading_table(uint index) { return shading_tables[index]; }
#include "shading/reflected_light.h"

layout(local_size_x = 64) in;
layout(set = 0, binding = 19, std430) buffer Exitance { vec4 exitance[]; };
layout(set = 0, binding = 28, std430) buffer Lobes { uvec4 face_lobes[]; };
layout(set = 0, binding = 27, std430) readonly buffer Shares { uvec2 traced_voxels[]; };  // of shadow_voxels.comp
layout(push_constant) uniform Push { InjectConstants push; };

const uint area_light_samples = 16u;

/// To all sides evenly, and ahead.
struct FaceLight {
    vec3 exitance;  // lux
    FaceLobe lobe;
};

/// Adds what the face reflects of the illuminance of a light whose mean direction is `toward`: the shorter, the wider the light. A lobe's
/// radiance is its exitance × density / clamped cosine. It is wider by the light's extent and by the spread of the face's normals:
/// of a small angle δ between them cos δ is the mean's length, and reflections turn by 2δ.
void reflect_light(vec3 illuminance, vec3 toward, VoxelFace face, inout FaceLight sum) {
    const Frame about = frame_from_normal(face.normal);
    const vec3 wi = to_local(about, normalize(toward));
    if (!has_lobes || face.specular <= 0.0f || wi.z <= 0.0f) {
        sum.exitance += face.albedo * illuminance;
        return;
    }
    const ReflectedLight reflected = reflected_light(face.albedo, face.specular, face.alpha, wi);
    sum.exitance += reflected.diffuse * illuminance;
    const float narrow = max(length(reflected.mean), 1.0e-6f);
    const float spread = min(length(toward), 1.0f) * max(0.0f, 1.0f - 4.0f * (1.0f - face.straight));
    const float cosine = reflected.mean.z / narrow;
    const float widened = lobe_clamped_cosine(lobe_concentration(narrow * spread), cosine) / lobe_clamped_cosine(lobe_concentration(narrow), cosine);
    const vec3 light = reflected.specular * illuminance / (max(reflected.clamped_cosine * widened, 1.0e-4f) * push.grid.radiance_unit);
    const float weight = dot(light, vec3(1.0f / 3.0f));
    sum.lobe.light += light;
    sum.lobe.direction += weight * spread * to_world(about, reflected.mean);
    sum.lobe.weight += weight;
}

void add_light(uint index, float weight, VoxelFace face, inout FaceLight reflected) {
    const LightData light = shining_light(push.light_first + index);
    const uint samples = light_is_delta(light) ? 1u : area_light_samples;
    vec3 sum = vec3(0.0f);
    vec4 toward = vec4(0.0f);
    for (uint i = 0u; i < samples; ++i) {
        const LightSample arriving = scene_light_sample(light, face.position, hammersley(i, samples));
        const float cosine = max(dot(arriving.direction, face.normal), 0.0f);
        sum += arriving.value * cosine;
        toward += cosine * vec4(arriving.direction, 1.0f);
    }
    if (sum == vec3(0.0f)) return;
    const float share = light_reaching(light, index, face.position, face.normal, shadow_filter_percentage_closer) / float(samples);
    if (share > 0.0f) reflect_light(sum * (weight * share), toward.xyz / toward.w, face, reflected);
}

const uint light_picks_a_face = 32u;

/// Of very many lights each face picks some, always the same ones: cones see the mean of many faces.
void add_lights(VoxelFace face, uint cell, inout FaceLight reflected) {
    LightPicks picks = light_picks(face.position, push.light_count, light_picks_a_face, unit_interval(pcg_hash(voxel_faces * cell + push.face)));
    LightPick pick;
    while (next_light(picks, pick))
        add_light(pick.light, pick.weight, face, reflected);
}

void main() {
    uint record;
    bool enclosed;
    if (!lit_record(push.face, linear_invocation(), record, enclosed)) return;
    if (shadows_traced) traced_shares = unpack_shares(traced_voxels[record]);
    const uint index = record * voxel_faces + push.face;
    FaceLight reflected = FaceLight(vec3(0.0f), no_lobe);
    if (push.add != 0u) {
        reflected.exitance = exitance[index].rgb;
        if (has_lobes) reflected.lobe = unpacked_lobe(face_lobes[index]);
    }
    add_lights(voxel_face(push.grid, record, push.face), record_cell[record], reflected);
    exitance[index] = vec4(reflected.exitance, 0.0f);
    if (has_lobes) face_lobes[index] = packed_lobe(reflected.lobe);
}
