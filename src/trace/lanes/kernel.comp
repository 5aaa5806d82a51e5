#version 460
// The path kernel as tools/lanes translates it for the CPU. Functions without a body that counts are fetch.h's.
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 1) in;

#include "shading/kernel_state.h"
#include "shading/scene_data.h"
float shading_table(uint index) { return 0.0; }
#include "shading/bsdf.h"
#include "shading/kernel_sampler.h"
#include "shading/kernel_tile_sampler.h"
#include "shading/luminaire_shape.h"
#include "shading/material_eval.h"
#include "shading/sky.h"
#include "shading/spherical_rectangle.h"

KernelFrame kernel_frame() { KernelFrame frame; return frame; }
InstanceData fetch_instance(uint i) { InstanceData instance; return instance; }
MaterialData fetch_material(uint i) { MaterialData material; return material; }
LightData fetch_light(uint i) { LightData light; return light; }
SkyData fetch_sky() { SkyData sky; return sky; }
KernelGeometry fetch_geometry(uint i) { KernelGeometry geometry; return geometry; }
uvec3 fetch_triangle(uint geometry, uint primitive) { return uvec3(0); }
vec3 fetch_position(uint geometry, uint vertex) { return vec3(0.0); }
vec3 fetch_normal(uint geometry, uint vertex) { return vec3(0.0); }
vec4 fetch_tangent(uint geometry, uint vertex) { return vec4(0.0); }
vec4 fetch_color(uint geometry, uint vertex) { return vec4(0.0); }
vec2 fetch_texcoord(uint geometry, uint set, uint vertex) { return vec2(0.0); }
KernelEmitter fetch_emitter(uint i) { KernelEmitter emitter; return emitter; }
uint fetch_first_emitter(uint instance) { return 0u; }
uint fetch_light_emitter(uint light) { return 0u; }
uint fetch_visible_light(uint i) { return 0u; }
KernelLightNode fetch_light_node(uint i) { KernelLightNode node; return node; }
float fetch_sky_cumulative(uint i) { return 0.0; }
float luminaire_value(uint i) { return 0.0; }
vec4 scene_texture(uint index, vec2 uv) { return vec4(0.0); }
vec2 scene_texture_size(uint index) { return vec2(0.0); }

#include "shading/path_kernel.h"

void main() {
    PathState path = path_begin(0u, 0u, 0u);
    KernelHit hit;
    path_take_hit(path, hit);
}
