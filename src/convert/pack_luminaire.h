#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "scene/light.h"
#include "shading/scene_data.h"

namespace heliodon::convert {

/// The measured intensities of a scene's luminaires in one array of floats (shading/luminaire.h says how), each
/// luminaire once.
class LuminaireTables {
public:
    /// Where the luminaire's table begins; it is appended where it is not there yet.
    std::uint32_t place(const std::shared_ptr<const Luminaire>& luminaire);
    void clear();
    [[nodiscard]] std::span<const float> values() const { return values_; }

private:
    std::map<std::shared_ptr<const Luminaire>, std::uint32_t> places_;
    std::vector<float> values_;
};

/// `light` with its luminaire, whose table begins at `table`. `world` moves, turns and mirrors it.
[[nodiscard]] shading::LightData pack_luminaire(const Light& light, const glm::mat4& world, std::uint32_t table);

}  // namespace heliodon::convert
