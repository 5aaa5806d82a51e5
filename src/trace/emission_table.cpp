#include "trace/emission_table.h"

#include <algorithm>
#include <numbers>

#include "core/units.h"

namespace heliodon::trace {

EmissionTable build_emission(const convert::FlatScene& flat, const EmitterTable& emitters, bool environment) {
    EmissionTable table;
    const Bounds bounds = flat.bounds();
    const float radius = bounds.empty() ? 1.0f : std::max(0.5f * bounds.diagonal(), 1e-6f);
    table.scene_sphere = glm::vec4(bounds.empty() ? glm::vec3(0) : bounds.center(), radius);
    const shading::SkyData& sky = flat.sky();
    const double luminance = units::luminance(glm::dvec3(sky.luminance));
    const bool sky_shines = environment && sky.model == shading::sky_model_constant && luminance > 0;
    const bool any = !emitters.emitters.empty() && emitters.emitters.back().cumulative > 0;
    // E = πL on the disc's πR².
    const double sky_flux = std::numbers::pi * luminance * std::numbers::pi * radius * radius;
    double rest = any ? 1 : 0;
    if (sky_shines && any)
        rest = 1 - 0.5 * sky_flux / (sky_flux + emitters.total_flux) - 0.5 / (emitters.lit_groups + 1.0);
    if (any)
        for (const shading::KernelEmitter& emitter : emitters.emitters)
            table.cumulative.push_back(static_cast<float>(rest * emitter.cumulative));
    if (sky_shines) table.cumulative.push_back(1.0f);
    return table;
}

}  // namespace heliodon::trace
