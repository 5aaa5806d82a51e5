#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <glm/vec4.hpp>

#include "core/units.h"
#include "import/texture_set.h"

namespace heliodon::import {
namespace {

std::uint8_t to_byte(float value) {
    return std::uint8_t(std::clamp(value, 0.0f, 1.0f) * 255.0f + 0.5f);
}

const std::array<float, 256>& srgb_table() {
    static const std::array<float, 256> table = [] {
        std::array<float, 256> values{};
        for (int i = 0; i < 256; ++i) values[i] = units::srgb_decode(i / 255.0f);
        return values;
    }();
    return table;
}

/// sRGB bytes of linear values, exact at every byte: the last byte whose lower rounding edge is not above.
std::uint8_t srgb_byte(float linear) {
    static const std::array<float, 255> edges = [] {
        std::array<float, 255> values{};
        for (int i = 0; i < 255; ++i) values[i] = units::srgb_decode((i + 0.5f) / 255.0f);
        return values;
    }();
    return std::uint8_t(std::upper_bound(edges.begin(), edges.end(), linear) - edges.begin());
}

/// A level in linear floats, four a texel.
struct LinearLevel {
    int width = 0;
    int height = 0;
    std::vector<glm::vec4> texels;
};

glm::vec4 decode(const Texture& texture, std::size_t i) {
    const std::uint8_t* bytes = texture.levels[0].data();
    if (texture.format == TextureFormat::float32) {
        glm::vec4 texel;
        std::memcpy(&texel, bytes + i * sizeof texel, sizeof texel);
        return texel;
    }
    const std::uint8_t* b = bytes + i * 4;
    if (texture.format == TextureFormat::linear8) return glm::vec4(b[0], b[1], b[2], b[3]) / 255.0f;
    const auto& table = srgb_table();
    return {table[b[0]], table[b[1]], table[b[2]], b[3] / 255.0f};
}

std::vector<std::uint8_t> encode(const LinearLevel& level, TextureFormat format, float alpha_scale) {
    std::vector<std::uint8_t> bytes(level.texels.size() * (format == TextureFormat::float32 ? 16 : 4));
    if (format == TextureFormat::float32) {
        std::memcpy(bytes.data(), level.texels.data(), bytes.size());
        return bytes;
    }
    for (std::size_t i = 0; i < level.texels.size(); ++i) {
        const glm::vec4 texel = level.texels[i];
        for (int c = 0; c < 3; ++c)
            bytes[i * 4 + c] = format == TextureFormat::srgb8 ? srgb_byte(texel[c]) : to_byte(texel[c]);
        bytes[i * 4 + 3] = to_byte(texel.w * alpha_scale);
    }
    return bytes;
}

/// The source texels under one texel of the next level, with the share of each: a box filter of exactly
/// size / max(1, size/2) texels, so that odd sizes keep their mean.
struct Taps {
    int first = 0;
    std::array<float, 3> weights{};
};

std::vector<Taps> box_taps(int size, int next) {
    // In units of 1/next of a source texel everything is whole: output i covers [i·size, (i + 1)·size).
    std::vector<Taps> taps(next);
    for (std::int64_t i = 0; i < next; ++i) {
        const std::int64_t begin = i * size, end = begin + size;
        taps[i].first = int(begin / next);
        for (int k = 0; k < 3; ++k) {
            const std::int64_t left = std::int64_t(taps[i].first + k) * next;
            const std::int64_t covered = std::min(end, left + next) - std::max(begin, left);
            taps[i].weights[k] = float(double(std::max<std::int64_t>(0, covered)) / size);
        }
    }
    return taps;
}

/// One level down. Colour is weighted by alpha where alpha means coverage, so that the colour of invisible
/// texels does not bleed.
template <class Texel>
LinearLevel halve(int width, int height, bool alpha_weighted, Texel&& texel) {
    LinearLevel next{std::max(1, width / 2), std::max(1, height / 2), {}};
    next.texels.resize(std::size_t(next.width) * next.height);
    const std::vector<Taps> columns = box_taps(width, next.width), rows = box_taps(height, next.height);
    for (int y = 0; y < next.height; ++y)
        for (int x = 0; x < next.width; ++x) {
            glm::vec4 sum(0), weighted(0);
            for (int j = 0; j < 3; ++j)
                for (int i = 0; i < 3; ++i) {
                    const float weight = rows[y].weights[j] * columns[x].weights[i];
                    if (weight <= 0) continue;
                    const glm::vec4 value = texel(columns[x].first + i, rows[y].first + j);
                    sum += weight * value;
                    weighted += weight * value.w * value;
                }
            if (alpha_weighted && sum.w > 0) sum = glm::vec4(glm::vec3(weighted) / sum.w, sum.w);
            next.texels[std::size_t(y) * next.width + x] = sum;
        }
    return next;
}

double coverage(const LinearLevel& level, float cutoff, float scale) {
    std::size_t above = 0;
    for (const glm::vec4& texel : level.texels) above += texel.w * scale >= cutoff;
    return double(above) / double(level.texels.size());
}

/// The factor on alpha that gives `level` the covered share `wanted` (Castaño 2010, "Computing Alpha
/// Mipmaps"), by bisection.
float coverage_scale(const LinearLevel& level, float cutoff, double wanted) {
    if (wanted <= 0 || wanted >= 1) return 1;
    float low = 0, high = 8;
    for (int step = 0; step < 16; ++step) {
        const float middle = 0.5f * (low + high);
        (coverage(level, cutoff, middle) < wanted ? low : high) = middle;
    }
    // Coverage steps where texels have equal alpha; the nearer side of the step is taken.
    return wanted - coverage(level, cutoff, low) < coverage(level, cutoff, high) - wanted ? low : high;
}

bool all_opaque(const Texture& texture) {
    const std::size_t count = std::size_t(texture.width) * texture.height;
    for (std::size_t i = 0; i < count; ++i) {
        if (texture.format == TextureFormat::float32 ? decode(texture, i).w < 1 : texture.levels[0][i * 4 + 3] != 255)
            return false;
    }
    return true;
}

}  // namespace

void build_mip_chain(Texture& texture, std::optional<float> alpha_cutoff) {
    texture.levels.resize(1);
    texture.opaque = all_opaque(texture);
    if (!texture.mipmapped) return;
    const bool alpha_weighted = texture.format == TextureFormat::srgb8 && !texture.opaque;
    const bool keep_coverage = alpha_cutoff && !texture.opaque;
    double wanted = 0;
    if (keep_coverage) {
        const std::size_t count = texture.levels[0].size() / 4;
        for (std::size_t i = 0; i < count; ++i) wanted += texture.levels[0][i * 4 + 3] / 255.0f >= *alpha_cutoff;
        wanted /= double(count);
    }
    LinearLevel level{texture.width, texture.height, {}};
    while (level.width > 1 || level.height > 1) {
        const int width = level.width, height = level.height;
        if (level.texels.empty())
            level = halve(width, height, alpha_weighted,
                          [&](int x, int y) { return decode(texture, std::size_t(y) * width + x); });
        else
            level = halve(width, height, alpha_weighted,
                          [&](int x, int y) { return level.texels[std::size_t(y) * width + x]; });
        const float scale = keep_coverage ? coverage_scale(level, *alpha_cutoff, wanted) : 1.0f;
        texture.levels.push_back(encode(level, texture.format, scale));
    }
}

}  // namespace heliodon::import
