// Records of the scene's tables, read at a place of its own by each lane.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>

#include "trace/lanes/lanes.h"

namespace heliodon::trace::lanes {

/// 16 bytes from eight places, as four numbers of eight lanes.
inline Vec4<Float> load_rows(const float* const (&at)[lane_count]) {
    const auto pair = [&](int i) {
        return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(at[i])), _mm_loadu_ps(at[i + 4]), 1);
    };
    const __m256 a = pair(0), b = pair(1), c = pair(2), d = pair(3);
    const __m256 ab_low = _mm256_unpacklo_ps(a, b), ab_high = _mm256_unpackhi_ps(a, b);
    const __m256 cd_low = _mm256_unpacklo_ps(c, d), cd_high = _mm256_unpackhi_ps(c, d);
    return {(Float)_mm256_shuffle_ps(ab_low, cd_low, 0x44), (Float)_mm256_shuffle_ps(ab_low, cd_low, 0xee),
            (Float)_mm256_shuffle_ps(ab_high, cd_high, 0x44), (Float)_mm256_shuffle_ps(ab_high, cd_high, 0xee)};
}
/// `offset` in bytes.
inline Vec4<Float> gather_row(const char* base, Int offset) {
    alignas(32) const float* at[lane_count];
    const __m256i first = _mm256_set1_epi64x(reinterpret_cast<long long>(base));
    const __m256i low = _mm256_cvtepi32_epi64(_mm256_castsi256_si128((__m256i)offset));
    const __m256i high = _mm256_cvtepi32_epi64(_mm256_extracti128_si256((__m256i)offset, 1));
    _mm256_store_si256(reinterpret_cast<__m256i*>(at), _mm256_add_epi64(first, low));
    _mm256_store_si256(reinterpret_cast<__m256i*>(at + 4), _mm256_add_epi64(first, high));
    return load_rows(at);
}
inline Float gather(const char* base, Int offset) {
    return (Float)_mm256_i32gather_ps(reinterpret_cast<const float*>(base), (__m256i)offset, 1);
}

/// Where each lane has a T (or, where T is part of another record, that part).
template <class T>
struct Record {
    const char* base;
    Int offset;  ///< bytes

    template <class Member, std::size_t member>
    [[nodiscard, gnu::always_inline]] auto get() const {
        const char* at = base + member;
        if constexpr (std::is_same_v<Member, float>) {
            return gather(at, offset);
        } else if constexpr (std::is_same_v<Member, std::uint32_t>) {
            return (Uint)gather(at, offset);
        } else if constexpr (std::is_same_v<Member, glm::vec2>) {
            return Vec2<Float>{gather(at, offset), gather(at + 4, offset)};
        } else if constexpr (std::is_same_v<Member, glm::vec3>) {
            static_assert(member + 16 <= sizeof(T), "a row must not reach past the table");
            const Vec4<Float> row = gather_row(at, offset);
            return Vec3<Float>{row.x, row.y, row.z};
        } else if constexpr (std::is_same_v<Member, glm::vec4>) {
            return gather_row(at, offset);
        } else {
            static_assert(std::is_same_v<Member, glm::mat4>);
            return Mat4{{gather_row(at, offset), gather_row(at + 16, offset), gather_row(at + 32, offset),
                         gather_row(at + 48, offset)}};
        }
    }
};
template <class R>
requires requires(R r) {
    r.base;
    r.offset;
}
inline void assign(Mask m, R& to, const R& from) {
    to.base = from.base;  // of the one table that such records stand in
    to.offset = choose(m, from.offset, to.offset);
}

inline auto shared(const glm::vec2& v) {
    return Vec2<float>{v.x, v.y};
}
inline auto shared(const glm::vec3& v) {
    return Vec3<float>{v.x, v.y, v.z};
}
inline auto shared(const glm::vec4& v) {
    return Vec4<float>{v.x, v.y, v.z, v.w};
}
inline float shared(float x) {
    return x;
}
inline std::uint32_t shared(std::uint32_t x) {
    return x;
}
template <class T>
struct SharedArray {
    const T* first;
    auto operator[](int i) const { return shared(first[i]); }
};
template <class T, std::size_t count>
inline auto shared(const T (&array)[count]) {
    return SharedArray<T>{array};
}

/// The one T that all lanes share.
template <class T>
struct SharedRecord {
    const T* record;

    template <class Member, std::size_t member>
    [[nodiscard]] auto get() const {
        return shared(*reinterpret_cast<const Member*>(reinterpret_cast<const char*>(record) + member));
    }
};
template <class R>
requires requires(R r) {
    r.record;
}
inline void assign(Mask, R& to, const R& from) {
    to = from;
}

}  // namespace heliodon::trace::lanes
