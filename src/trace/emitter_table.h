#pragma once

#include <cstdint>
#include <vector>

#include "convert/flat_scene.h"
#include "shading/kernel_state.h"
#include "trace/texture_table.h"

namespace heliodon::trace {

/// What next-event estimation selects from. Each emitter has a share of the samples, half by luminous flux, half
/// evenly over lights, emissive instances and a sky that varies, so that neither a weak lamp beside the sun nor one
/// triangle of a thousand starves. Directional lights and the sky, which stand first, keep it; what all others have
/// together is shared among them by a tree, anew for each place.
struct EmitterTable {
    std::vector<shading::KernelEmitter> emitters;
    std::vector<std::uint32_t> first_emitter;   ///< by instance; kernel_no_emitter where it emits nothing
    std::vector<std::uint32_t> light_emitter;   ///< by light; kernel_no_emitter for a hole
    std::vector<std::uint32_t> visible_lights;  ///< lights with an extent: scattered rays can meet them
    std::uint32_t sky_emitter = shading::kernel_no_emitter;
    /// The luminance of a sky that varies: cumulative over rows, then a cumulative row each; cells are equal steps of
    /// azimuth and polar angle.
    std::vector<float> sky_cumulative;
    std::uint32_t sky_columns = 0, sky_rows = 0;
    std::uint32_t distant_emitters = 0;
    std::vector<shading::KernelLightNode> light_nodes;
    bool scattered_emission = false;  ///< any light that a scattered ray can meet
    double total_flux = 0;            ///< lm, of all emitters
    int lit_groups = 0;               ///< lights, emissive instances and varying skies that give any
};

[[nodiscard]] EmitterTable build_emitters(const convert::FlatScene& flat, const TextureTable& textures,
                                          bool environment);

}  // namespace heliodon::trace
