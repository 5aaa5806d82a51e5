#include "realtime/vertex_packing.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "passes/common/frame_shared.h"
#include "shading/octahedral.h"

namespace heliodon::realtime {
namespace {

constexpr float widest_texcoord_range = 16.0f;
constexpr std::size_t texcoord_header_words = 4;

std::uint32_t signed_bits(float value, float largest, std::uint32_t mask) {
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(std::lround(value * largest))) & mask;
}

struct Range {
    glm::vec2 low{0}, high{0};
};
Range range_of(std::span<const glm::vec2> texcoords) {
    if (texcoords.empty()) return {};
    Range range{texcoords[0], texcoords[0]};
    for (const glm::vec2 uv : texcoords) {
        range.low = glm::min(range.low, uv);
        range.high = glm::max(range.high, uv);
    }
    return range;
}

bool has_direction(glm::vec3 v) { return glm::dot(v, v) > 0.0f; }

}  // namespace

std::vector<std::uint32_t> pack_normals(std::span<const glm::vec3> normals) {
    std::vector<std::uint32_t> words;
    words.reserve(normals.size());
    for (const glm::vec3 normal : normals) {
        const glm::vec2 e = has_direction(normal) ? shading::octahedral_encode(normal) : glm::vec2(0);
        words.push_back(has_direction(normal)
                            ? signed_bits(e.x, 32767.0f, 0xffffu) | signed_bits(e.y, 32767.0f, 0xffffu) << 16
                            : shading::compact_normal_zero);
    }
    return words;
}

std::vector<std::uint32_t> pack_tangents(std::span<const glm::vec4> tangents) {
    std::vector<std::uint32_t> words;
    words.reserve(tangents.size());
    for (const glm::vec4 tangent : tangents) {
        const glm::vec3 direction(tangent);
        const glm::vec2 e = has_direction(direction) ? shading::octahedral_encode(direction) : glm::vec2(0);
        const std::uint32_t code = has_direction(direction)
                                       ? signed_bits(e.x, 32767.0f, 0xffffu) | signed_bits(e.y, 16383.0f, 0x7fffu) << 16
                                       : shading::compact_tangent_zero;
        words.push_back(code | (tangent.w < 0 ? shading::compact_tangent_negative : 0u));
    }
    return words;
}

bool packs_texcoords(std::span<const glm::vec2> texcoords) {
    if (texcoords.size() <= texcoord_header_words) return false;
    const Range range = range_of(texcoords);
    const glm::vec2 extent = range.high - range.low;
    return extent.x <= widest_texcoord_range && extent.y <= widest_texcoord_range;  // false for NaN
}

std::vector<std::uint32_t> pack_texcoords(std::span<const glm::vec2> texcoords) {
    const Range range = range_of(texcoords);
    const glm::vec2 step = (range.high - range.low) / 65535.0f;
    std::vector<std::uint32_t> words;
    words.reserve(texcoord_header_words + texcoords.size());
    for (const float value : {range.low.x, range.low.y, step.x, step.y}) words.push_back(std::bit_cast<std::uint32_t>(value));
    const auto code = [](float offset, float unit) {
        return unit > 0 ? static_cast<std::uint32_t>(std::clamp(std::lround(offset / unit), 0l, 65535l)) : 0u;
    };
    for (const glm::vec2 uv : texcoords)
        words.push_back(code(uv.x - range.low.x, step.x) | code(uv.y - range.low.y, step.y) << 16);
    return words;
}

}  // namespace heliodon::realtime
