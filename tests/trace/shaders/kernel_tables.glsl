// The scene in buffers, as the kernels fetch it.
#include "shading/kernel_state.h"
#include "shading/scene_data.h"

layout(scalar, binding = 0) readonly buffer Frames { KernelFrame frames[]; };
layout(scalar, binding = 1) readonly buffer Instances { InstanceData instances[]; };
layout(scalar, binding = 2) readonly buffer Materials { MaterialData materials[]; };
layout(scalar, binding = 3) readonly buffer Lights { LightData lights[]; };
layout(scalar, binding = 4) readonly buffer Skies { SkyData skies[]; };
layout(scalar, binding = 5) readonly buffer Geometries { KernelGeometry geometries[]; };
/// First vertex and first index of each geometry.
layout(scalar, binding = 6) readonly buffer Places { uvec2 places[]; };
layout(scalar, binding = 7) readonly buffer Indices { uint indices[]; };
layout(scalar, binding = 8) readonly buffer Positions { vec3 positions[]; };
layout(scalar, binding = 9) readonly buffer Normals { vec3 normals[]; };
layout(scalar, binding = 10) readonly buffer Emitters { KernelEmitter emitters[]; };
/// first_emitter by instance, then light_emitter by light, then the visible lights, then the light tree's nodes.
layout(scalar, binding = 11) readonly buffer EmitterIndices { uint emitter_indices[]; };
layout(scalar, binding = 12) readonly buffer Tables { float tables[]; };
layout(scalar, binding = 13) readonly buffer Hits { KernelHit hits[]; };
layout(scalar, binding = 15) buffer Rays { KernelRay rays[]; };
layout(push_constant) uniform Push { uint path_count; uint begin; uint instance_count; uint light_count; };

float shading_table(uint index) { return tables[index]; }

#include "shading/bsdf.h"
#include "shading/kernel_sampler.h"
#include "shading/kernel_tile_sampler.h"
#include "shading/luminaire_shape.h"
#include "shading/material_eval.h"
#include "shading/sky.h"
#include "shading/spherical_rectangle.h"

KernelFrame kernel_frame() { return frames[0]; }
InstanceData fetch_instance(uint i) { return instances[i]; }
MaterialData fetch_material(uint i) { return materials[i]; }
LightData fetch_light(uint i) { return lights[i]; }
SkyData fetch_sky() { return skies[0]; }
KernelGeometry fetch_geometry(uint i) { return geometries[i]; }
uvec3 fetch_triangle(uint geometry, uint primitive) {
    const uint first = places[geometry].y + 3u * primitive;
    return uvec3(indices[first], indices[first + 1u], indices[first + 2u]);
}
vec3 fetch_position(uint geometry, uint vertex) { return positions[places[geometry].x + vertex]; }
vec3 fetch_normal(uint geometry, uint vertex) { return normals[places[geometry].x + vertex]; }
// The test's scene has no textures and no luminaires: nothing reads these.
float luminaire_value(uint i) { return 0.0; }
vec4 fetch_tangent(uint geometry, uint vertex) { return vec4(1.0, 0.0, 0.0, 1.0); }
vec4 fetch_color(uint geometry, uint vertex) { return vec4(1.0); }
vec2 fetch_texcoord(uint geometry, uint set, uint vertex) { return vec2(0.0); }
KernelEmitter fetch_emitter(uint i) { return emitters[i]; }
uint fetch_first_emitter(uint instance) { return emitter_indices[instance]; }
uint fetch_light_emitter(uint light) { return emitter_indices[instance_count + light]; }
uint fetch_visible_light(uint i) { return emitter_indices[instance_count + light_count + i]; }
KernelLightNode fetch_light_node(uint i) {
    const uint at = instance_count + light_count + frames[0].visible_light_count + 16u * i;
    KernelLightNode node;
    node.bounds_min = uintBitsToFloat(uvec3(emitter_indices[at], emitter_indices[at + 1u], emitter_indices[at + 2u]));
    node.intensity = uintBitsToFloat(emitter_indices[at + 3u]);
    node.bounds_max = uintBitsToFloat(uvec3(emitter_indices[at + 4u], emitter_indices[at + 5u], emitter_indices[at + 6u]));
    node.child = emitter_indices[at + 7u];
    node.axis = uintBitsToFloat(uvec3(emitter_indices[at + 8u], emitter_indices[at + 9u], emitter_indices[at + 10u]));
    node.cos_normals = uintBitsToFloat(emitter_indices[at + 11u]);
    node.cos_emission = uintBitsToFloat(emitter_indices[at + 12u]);
    node.parent = emitter_indices[at + 13u];
    node.flags = emitter_indices[at + 14u];
    return node;
}
float fetch_sky_cumulative(uint i) { return 0.0; }
vec4 scene_texture(uint index, vec2 uv) { return vec4(1.0); }
vec2 scene_texture_size(uint index) { return vec2(1.0); }

