#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace heliodon {

/// Linear picture, rows from the top, `channels` interleaved floats a pixel (1, 2, 3 or 4). Colour is
/// linear Rec. 709; rendered pictures hold cd/m².
struct Image {
    int width = 0;
    int height = 0;
    int channels = 3;
    std::vector<float> pixels;  ///< width · height · channels

    Image() = default;
    Image(int width_, int height_, int channels_, float value = 0.0f)
        : width(width_), height(height_), channels(channels_),
          pixels(static_cast<std::size_t>(width_) * height_ * channels_, value) {}

    [[nodiscard]] std::size_t index(int x, int y, int channel = 0) const {
        return (static_cast<std::size_t>(y) * width + x) * channels + channel;
    }
    [[nodiscard]] float& at(int x, int y, int channel = 0) { return pixels[index(x, y, channel)]; }
    [[nodiscard]] float at(int x, int y, int channel = 0) const { return pixels[index(x, y, channel)]; }
    [[nodiscard]] glm::vec3 rgb(int x, int y) const {
        const float* p = &pixels[index(x, y)];
        return channels >= 3 ? glm::vec3(p[0], p[1], p[2]) : glm::vec3(p[0]);
    }
};

/// A named extra layer of a rendered picture (an AOV), written as an EXR layer.
struct Layer {
    std::string name;
    Image image;
};

/// What a renderer returns and a file holds: the beauty picture in cd/m², its AOVs and its exposure.
struct Picture {
    Image image;                ///< RGB or RGBA, cd/m²
    std::vector<Layer> layers;  ///< AOVs, in the order asked for
    float ev100 = 0.0f;         ///< exposure of the camera that took it
    bool has_ev100 = false;
    std::map<std::string, std::string> attributes;  ///< Heliodon's own notes in an EXR, by name
};

}  // namespace heliodon
