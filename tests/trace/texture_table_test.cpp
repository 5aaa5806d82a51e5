#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "trace/texture_table.h"

namespace heliodon::tests {
namespace {

constexpr int width = 5, height = 3;

float value(int x, int y) { return static_cast<float>(10 * y + x); }

/// glTF 2.0's wrap modes, by their definition on whole texels.
int wrapped(int i, int size, Wrap wrap) {
    const auto modulo = [](int a, int b) { return ((a % b) + b) % b; };
    if (wrap == Wrap::clamp_to_edge) return std::clamp(i, 0, size - 1);
    if (wrap == Wrap::repeat) return modulo(i, size);
    const int in_two = modulo(i, 2 * size);
    return in_two < size ? in_two : 2 * size - 1 - in_two;
}

Texture numbered_texture(Wrap wrap_u, Wrap wrap_v, Filter filter) {
    Texture texture{.width = width, .height = height, .format = TextureFormat::float32, .wrap_u = wrap_u, .wrap_v = wrap_v, .magnify = filter};
    texture.levels.emplace_back(16 * width * height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const float v = value(x, y);
            std::memcpy(texture.levels[0].data() + 16 * (y * width + x), &v, 4);
        }
    return texture;
}

TEST(Textures, RepeatMirrorAndClampFarOutsideOfTheirFirstPeriod) {
    for (const Wrap wrap_u : {Wrap::repeat, Wrap::mirrored_repeat, Wrap::clamp_to_edge})
        for (const Wrap wrap_v : {Wrap::repeat, Wrap::mirrored_repeat, Wrap::clamp_to_edge}) {
            Scene scene;
            const TextureId nearest = scene.add_texture(numbered_texture(wrap_u, wrap_v, Filter::nearest));
            const TextureId linear = scene.add_texture(numbered_texture(wrap_u, wrap_v, Filter::linear));
            convert::FlatScene flat;
            flat.update(scene);
            trace::TextureTable table;
            table.update(flat);
            const auto at = [&](int x, int y) { return value(wrapped(x, width, wrap_u), wrapped(y, height, wrap_v)); };
            for (int y = -4 * height; y < 4 * height; ++y)
                for (int x = -4 * width; x < 4 * width; ++x) {
                    const glm::vec2 middle((x + .5f) / width, (y + .5f) / height), corner((x + 1.0f) / width, (y + 1.0f) / height);
                    EXPECT_EQ(table.sample(nearest.index, middle).x, at(x, y)) << x << ' ' << y;
                    const float mean = (at(x, y) + at(x + 1, y) + at(x, y + 1) + at(x + 1, y + 1)) / 4;
                    EXPECT_NEAR(table.sample(linear.index, corner).x, mean, 2e-4) << x << ' ' << y;
                }
            EXPECT_TRUE(std::isfinite(table.sample(linear.index, {3e9f, NAN}).x));
            EXPECT_TRUE(std::isfinite(table.sample(linear.index, {-9e8f, 9e8f}).x));
        }
}

}  // namespace
}  // namespace heliodon::tests
