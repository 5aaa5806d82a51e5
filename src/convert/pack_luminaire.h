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
    struct Place {
        std::uint32_t table = 0;         ///< where its table begins
        std::uint32_t face_weights = 0;  ///< LightData::face_weights: each face of the opening by the flux that leaves it
    };
    /// Appends the table where it is not there yet.
    Place place(const std::shared_ptr<const Luminaire>& luminaire);
    void clear();
    [[nodiscard]] std::span<const float> values() const { return values_; }

private:
    std::map<std::shared_ptr<const Luminaire>, Place> places_;
    std::vector<float> values_;
};

/// `light` with its luminaire, whose table lies at `place`. `world` moves, turns and mirrors it.
[[nodiscard]] shading::LightData pack_luminaire(const Light& light, const glm::mat4& world, const LuminaireTables::Place& place);

}  // namespace heliodon::convert
