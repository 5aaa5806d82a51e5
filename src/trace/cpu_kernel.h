#pragma once

#include <cstdint>
#include <span>

#include "convert/flat_scene.h"
#include "shading/bsdf.h"
#include "shading/kernel_sampler.h"
#include "shading/kernel_state.h"
#include "shading/kernel_tile_sampler.h"
#include "shading/light.h"
#include "shading/luminaire_shape.h"
#include "shading/material_eval.h"
#include "shading/sky.h"
#include "shading/spherical_rectangle.h"
#include "trace/emitter_table.h"
#include "trace/geometry_table.h"
#include "trace/texture_table.h"

namespace heliodon::trace {

using namespace heliodon::shading;

/// The light-transport kernel over the flat scene's tables. Copying it copies references only.
struct CpuKernel {
    const convert::FlatScene& flat;
    const GeometryTable& geometry_table;
    const TextureTable& textures;
    const EmitterTable& emitter_table;
    KernelFrame frame;

    // -- the kernel's thin interface
    const KernelFrame& kernel_frame() const { return frame; }
    const InstanceData& fetch_instance(uint index) const { return flat.instances()[index]; }
    const MaterialData& fetch_material(uint index) const { return flat.materials()[index]; }
    const LightData& fetch_light(uint index) const { return flat.lights()[index]; }
    float luminaire_value(uint i) const { return flat.luminaire_table()[i]; }
    const SkyData& fetch_sky() const { return flat.sky(); }
    const KernelGeometry& fetch_geometry(uint geometry) const { return geometry_table[geometry].kernel; }
    uvec3 fetch_triangle(uint geometry, uint primitive) const {
        const std::uint32_t* index = geometry_table[geometry].indices + 3 * static_cast<std::size_t>(primitive);
        return {index[0], index[1], index[2]};
    }
    vec3 fetch_position(uint geometry, uint vertex) const { return geometry_table[geometry].positions[vertex]; }
    vec3 fetch_normal(uint geometry, uint vertex) const { return geometry_table[geometry].normals[vertex]; }
    vec4 fetch_tangent(uint geometry, uint vertex) const { return geometry_table[geometry].tangents[vertex]; }
    vec4 fetch_color(uint geometry, uint vertex) const { return geometry_table[geometry].colors[vertex]; }
    vec2 fetch_texcoord(uint geometry, uint set, uint vertex) const {
        return geometry_table[geometry].texcoords[set][vertex];
    }
    const KernelEmitter& fetch_emitter(uint index) const { return emitter_table.emitters[index]; }
    uint fetch_first_emitter(uint instance) const { return emitter_table.first_emitter[instance]; }
    uint fetch_light_emitter(uint light) const { return emitter_table.light_emitter[light]; }
    uint fetch_visible_light(uint i) const { return emitter_table.visible_lights[i]; }
    const KernelLightNode& fetch_light_node(uint i) const { return emitter_table.light_nodes[i]; }
    float fetch_sky_cumulative(uint i) const { return emitter_table.sky_cumulative[i]; }
    vec4 scene_texture(uint index, vec2 uv) const { return textures.sample(index, uv); }
    vec2 scene_texture_size(uint index) const { return vec2(textures.size(index)); }

#include "shading/path_kernel.h"
};

}  // namespace heliodon::trace
