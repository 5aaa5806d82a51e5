#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/image.h"
#include "core/result.h"
#include "scene/scene.h"
#include "scene/sensor_reading.h"

namespace heliodon::cli {

/// A pixel that is asked about, from the top left corner.
struct ProbedPixel {
    int x = 0, y = 0;
};

/// What lies under a pixel.
struct ProbeReading {
    ProbedPixel pixel;
    glm::vec3 luminance_rgb{0};                 ///< cd/m², of the picture
    std::optional<glm::vec3> position, normal;  ///< of the first surface in the pixel's middle, if there is one
    SensorReading illuminance;                  ///< there, lux
};

/// The two things that an engine is asked for.
struct ProbeEngine {
    std::function<Result<Picture>(const Camera&, int width, int height)> layers;  ///< position, normal and depth
    std::function<Result<std::vector<SensorReading>>(const Scene&)> measure;
};

/// Reads `picture`, which `camera` took of `scene`. The scene's sensors are replaced by those of the probes.
[[nodiscard]] Result<std::vector<ProbeReading>> probe(Scene& scene, const Camera& camera, const Picture& picture,
                                                      const std::vector<ProbedPixel>& pixels, const ProbeEngine& engine);

[[nodiscard]] std::string as_text(const std::vector<ProbeReading>& readings);
[[nodiscard]] nlohmann::json as_json(const std::vector<ProbeReading>& readings);

}  // namespace heliodon::cli
