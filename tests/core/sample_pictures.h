#pragma once

#include <cmath>
#include <random>

#include "core/image.h"

namespace heliodon::tests {

/// Values that differ everywhere, over many powers of ten.
inline Image hdr_noise(int width, int height, int channels, unsigned seed) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<float> exponent(-4.0f, 5.0f);
    Image image(width, height, channels);
    for (float& value : image.pixels) value = std::pow(10.0f, exponent(generator));
    return image;
}

/// Values in [0, 1].
inline Image unit_noise(int width, int height, int channels, unsigned seed) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
    Image image(width, height, channels);
    for (float& value : image.pixels) value = uniform(generator);
    return image;
}

/// A smooth picture in [0, 1], as JPEG likes it.
inline Image gradient(int width, int height) {
    Image image(width, height, 3);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            image.at(x, y, 0) = static_cast<float>(x) / static_cast<float>(width);
            image.at(x, y, 1) = static_cast<float>(y) / static_cast<float>(height);
            image.at(x, y, 2) = 0.5f;
        }
    }
    return image;
}

}  // namespace heliodon::tests
