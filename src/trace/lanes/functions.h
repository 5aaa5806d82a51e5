// GLSL's functions of numbers and vectors of eight lanes; of numbers that all lanes share where the kernel calls them so.
#pragma once

#include "trace/lanes/lanes.h"

namespace heliodon::trace::lanes {


inline Float to_float(Uint x) {
    return __builtin_convertvector(x, Float);
}
inline Float to_float(Int x) {
    return __builtin_convertvector(x, Float);
}
inline float to_float(std::uint32_t x) {
    return static_cast<float>(x);
}
inline Uint to_uint(Float x) {
    return (Uint)_mm256_cvttps_epi32((__m256)x);
}  // of numbers below 2³¹
inline std::uint32_t to_uint(float x) {
    return static_cast<std::uint32_t>(x);
}
inline Float bits_to_float(Uint x) {
    return (Float)x;
}
inline Uint bits_to_uint(Float x) {
    return (Uint)x;
}

/// Lanes that do not count may divide by 0.
inline Uint divide(Uint a, Uint b) {
    return a / (b | ((Uint)(b == 0u) & 1u));
}
inline Uint divide(Number auto a, Number auto b) {
    return divide(lift(a), lift(b));
}
inline Uint modulo(Uint a, Uint b) {
    return a % (b | ((Uint)(b == 0u) & 1u));
}
inline Uint modulo(Number auto a, Number auto b) {
    return modulo(lift(a), lift(b));
}

/// By tables: the halves of each byte, turned round, change places, and so do the bytes.
inline Uint reverse_bits(Uint x) {
    const __m256i order = _mm256_setr_epi8(3, 2, 1, 0, 7, 6, 5, 4, 11, 10, 9, 8, 15, 14, 13, 12, 3, 2, 1, 0, 7, 6, 5, 4,
                                           11, 10, 9, 8, 15, 14, 13, 12);
    const __m256i turned = _mm256_setr_epi8(0, 8, 4, 12, 2, 10, 6, 14, 1, 9, 5, 13, 3, 11, 7, 15, 0, 8, 4, 12, 2, 10, 6,
                                            14, 1, 9, 5, 13, 3, 11, 7, 15);
    const __m256i half = _mm256_set1_epi8(15);
    const __m256i bytes = _mm256_shuffle_epi8((__m256i)x, order);
    const __m256i low = _mm256_shuffle_epi8(turned, _mm256_and_si256(bytes, half));
    const __m256i high = _mm256_shuffle_epi8(turned, _mm256_and_si256(_mm256_srli_epi32(bytes, 4), half));
    return (Uint)_mm256_or_si256(_mm256_slli_epi32(low, 4), high);
}
inline Uint reverse_bits(std::uint32_t x) {
    return reverse_bits(lift(x));
}

// GLSL: y < x ? y : x, and x < y ? y : x.
inline Float min(Float x, Float y) {
    return (Float)_mm256_min_ps((__m256)y, (__m256)x);
}
inline Float max(Float x, Float y) {
    return (Float)_mm256_max_ps((__m256)y, (__m256)x);
}
inline Uint min(Uint x, Uint y) {
    return (Uint)_mm256_min_epu32((__m256i)x, (__m256i)y);
}
inline Uint max(Uint x, Uint y) {
    return (Uint)_mm256_max_epu32((__m256i)x, (__m256i)y);
}
inline float min(float x, float y) {
    return y < x ? y : x;
}
inline float max(float x, float y) {
    return x < y ? y : x;
}
inline std::uint32_t min(std::uint32_t x, std::uint32_t y) {
    return y < x ? y : x;
}
template <Number A, Number B>
requires(!std::is_same_v<A, B>) inline auto min(A x, B y) {
    return min(lift(x), lift(y));
}
template <Number A, Number B>
requires(!std::is_same_v<A, B>) inline auto max(A x, B y) {
    return max(lift(x), lift(y));
}
inline Float sqrt(Float x) {
    return (Float)_mm256_sqrt_ps((__m256)x);
}
inline float sqrt(float x) {
    return std::sqrt(x);
}
inline auto inversesqrt(Number auto x) {
    return 1.0f / sqrt(x);
}
inline Float abs(Float x) {
    return (Float)((Uint)x & 0x7fffffffu);
}
inline float abs(float x) {
    return std::abs(x);
}
inline Float floor(Float x) {
    return (Float)_mm256_floor_ps((__m256)x);
}
inline Float fract(Float x) {
    return x - floor(x);
}
inline Float sign(Float x) {
    return (Float)(((Uint)lift(1.0f) & (Uint)(x > 0.0f)) | ((Uint)lift(-1.0f) & (Uint)(x < 0.0f)));
}

// glibc's own vector functions (libmvec), within 4 units in the last place.
extern "C" {
__m256 _ZGVdN8v_sinf(__m256);
__m256 _ZGVdN8v_cosf(__m256);
__m256 _ZGVdN8v_tanf(__m256);
__m256 _ZGVdN8v_asinf(__m256);
__m256 _ZGVdN8v_acosf(__m256);
__m256 _ZGVdN8v_atanf(__m256);
__m256 _ZGVdN8v_expf(__m256);
__m256 _ZGVdN8v_logf(__m256);
__m256 _ZGVdN8v_exp2f(__m256);
__m256 _ZGVdN8v_log2f(__m256);
__m256 _ZGVdN8vv_atan2f(__m256, __m256);
__m256 _ZGVdN8vv_powf(__m256, __m256);
}
inline Float sin(Float x) {
    return (Float)_ZGVdN8v_sinf((__m256)x);
}
inline Float cos(Float x) {
    return (Float)_ZGVdN8v_cosf((__m256)x);
}
inline Float tan(Float x) {
    return (Float)_ZGVdN8v_tanf((__m256)x);
}
inline Float asin(Float x) {
    return (Float)_ZGVdN8v_asinf((__m256)x);
}
inline Float acos(Float x) {
    return (Float)_ZGVdN8v_acosf((__m256)x);
}
inline Float atan(Float x) {
    return (Float)_ZGVdN8v_atanf((__m256)x);
}
inline Float exp(Float x) {
    return (Float)_ZGVdN8v_expf((__m256)x);
}
inline Float log(Float x) {
    return (Float)_ZGVdN8v_logf((__m256)x);
}
inline Float exp2(Float x) {
    return (Float)_ZGVdN8v_exp2f((__m256)x);
}
inline Float log2(Float x) {
    return (Float)_ZGVdN8v_log2f((__m256)x);
}
inline Float atan2(Number auto y, Number auto x) {
    return (Float)_ZGVdN8vv_atan2f((__m256)lift(y), (__m256)lift(x));
}
inline Float pow(Number auto x, Number auto y) {
    return (Float)_ZGVdN8vv_powf((__m256)lift(x), (__m256)lift(y));
}
inline float sin(float x) {
    return std::sin(x);
}
inline float cos(float x) {
    return std::cos(x);
}

template <Number A, Number B, Number C>
inline auto clamp(A x, B low, C high) {
    return min(max(x, low), high);
}
template <Number A, Number B, Number C>
inline auto mix(A x, B y, C t) {
    return x * (1.0f - t) + y * t;
}
inline auto smoothstep(Number auto low, Number auto high, Number auto x) {
    const auto t = clamp((x - low) / (high - low), 0.0f, 1.0f);
    return t * t * (3.0f - 2.0f * t);
}

template <Number A, Number B>
inline auto dot(const Vec2<A>& a, const Vec2<B>& b) {
    return a.x * b.x + a.y * b.y;
}
template <Number A, Number B>
inline auto dot(const Vec3<A>& a, const Vec3<B>& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <Number A, Number B>
inline auto cross(const Vec3<A>& a, const Vec3<B>& b) {
    return vec(a.y * b.z - b.y * a.z, a.z * b.x - b.z * a.x, a.x * b.y - b.x * a.y);
}
inline auto reverse_bits(const Vector auto& v) {
    return each(v, [](auto p) { return reverse_bits(p); });
}
inline auto length(const Vector auto& v) {
    return sqrt(dot(v, v));
}
inline auto normalize(const Vector auto& v) {
    return v * inversesqrt(dot(v, v));
}
inline auto abs(const Vector auto& v) {
    return each(v, [](auto p) { return abs(p); });
}
inline auto sqrt(const Vector auto& v) {
    return each(v, [](auto p) { return sqrt(p); });
}
inline auto exp(const Vector auto& v) {
    return each(v, [](auto p) { return exp(p); });
}
inline auto cos(const Vector auto& v) {
    return each(v, [](auto p) { return cos(p); });
}
inline auto sin(const Vector auto& v) {
    return each(v, [](auto p) { return sin(p); });
}
inline auto floor(const Vector auto& v) {
    return each(v, [](auto p) { return floor(p); });
}
inline auto min(const Vector auto& a, const Vector auto& b) {
    return each(a, b, [](auto p, auto q) { return min(p, q); });
}
inline auto max(const Vector auto& a, const Vector auto& b) {
    return each(a, b, [](auto p, auto q) { return max(p, q); });
}
inline auto clamp(const Vector auto& x, const Vector auto& low, const Vector auto& high) {
    return min(max(x, low), high);
}
inline auto pow(const Vector auto& a, const Vector auto& b) {
    return each(a, b, [](auto p, auto q) { return pow(p, q); });
}
inline auto mix(const Vector auto& x, const Vector auto& y, const Vector auto& t) {
    return x * (each(t, [](auto p) { return 1.0f - p; })) + y * t;
}

}  // namespace heliodon::trace::lanes
