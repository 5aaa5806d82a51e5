// What translated kernels (tools/lanes) compute with: eight lanes of a number, vectors of them, masks of active lanes,
// and GLSL's functions of these. Numbers that all lanes share are plain floats and integers; both mix.
//
// Only files compiled for AVX2 and FMA may include this: nothing here is for processors without.
#pragma once

#include <immintrin.h>

#include <cmath>
#include <cstdint>
#include <type_traits>

namespace heliodon::trace::lanes {

constexpr int lane_count = 8;
using Float = float __attribute__((vector_size(32)));
using Uint = std::uint32_t __attribute__((vector_size(32)));
using Int = std::int32_t __attribute__((vector_size(32)));
using Mask = Int;  // −1 where a lane is active, else 0

template <class T>
concept Lanes = std::is_same_v<T, Float> || std::is_same_v<T, Uint> || std::is_same_v<T, Int>;
template <class T>
concept Number = Lanes<T> || std::is_arithmetic_v<T>;

template <Number T>
struct Vec2 {
    T x, y;
};
template <Number T>
struct Vec3 {
    T x, y, z;
};
template <Number T>
struct Vec4 {
    T x, y, z, w;
};
struct Mat4 {
    Vec4<Float> column[4];
};

template <class T>
constexpr bool is_vector = false;
template <class T>
constexpr bool is_vector<Vec2<T>> = true;
template <class T>
constexpr bool is_vector<Vec3<T>> = true;
template <class T>
constexpr bool is_vector<Vec4<T>> = true;
template <class T>
concept Vector = is_vector<T>;

// -- masks

inline bool any(Mask m) { return !_mm256_testz_si256((__m256i)m, (__m256i)m); }
inline unsigned bits(Mask m) { return static_cast<unsigned>(_mm256_movemask_ps((__m256)m)); }
inline Mask as_mask(Mask m) { return m; }
inline Mask as_mask(bool b) { return Mask{} - static_cast<int>(b); }
inline bool both(bool a, bool b) { return a && b; }
inline Mask both(auto a, auto b) { return as_mask(a) & as_mask(b); }
inline bool either(bool a, bool b) { return a || b; }
inline Mask either(auto a, auto b) { return as_mask(a) | as_mask(b); }
inline bool no(bool a) { return !a; }
inline Mask no(Mask a) { return ~a; }
inline bool differ(bool a, bool b) { return a != b; }
inline Mask differ(auto a, auto b) { return as_mask(a) ^ as_mask(b); }

// -- the same number in all lanes

inline Float lift(float x) { return Float{} + x; }
inline Uint lift(std::uint32_t x) { return Uint{} + x; }
inline Int lift(std::int32_t x) { return Int{} + x; }
inline Mask lift(bool x) { return as_mask(x); }
template <Lanes T>
inline T lift(T x) {
    return x;
}
template <Number T>
inline auto lift(const Vec2<T>& v) {
    return Vec2<decltype(lift(v.x))>{lift(v.x), lift(v.y)};
}
template <Number T>
inline auto lift(const Vec3<T>& v) {
    return Vec3<decltype(lift(v.x))>{lift(v.x), lift(v.y), lift(v.z)};
}
template <Number T>
inline auto lift(const Vec4<T>& v) {
    return Vec4<decltype(lift(v.x))>{lift(v.x), lift(v.y), lift(v.z), lift(v.w)};
}

// -- choosing

inline Float choose(Mask m, Float a, Float b) { return (Float)_mm256_blendv_ps((__m256)b, (__m256)a, (__m256)m); }
inline Uint choose(Mask m, Uint a, Uint b) { return (Uint)choose(m, (Float)a, (Float)b); }
inline Int choose(Mask m, Int a, Int b) { return (Int)choose(m, (Float)a, (Float)b); }

template <Number A, Number B>
inline auto select(Mask m, A a, B b) {
    return choose(m, lift(a), lift(b));
}
template <Number A>
inline A select(bool m, A a, A b) {
    return m ? a : b;
}
template <Number A, Number B>
    requires(!std::is_same_v<A, B>)
inline auto select(bool m, A a, B b) {
    return choose(as_mask(m), lift(a), lift(b));
}
template <Number A, Number B>
inline auto select(const Vec2<Mask>& m, const Vec2<A>& a, const Vec2<B>& b) {
    return Vec2<decltype(select(m.x, a.x, b.x))>{select(m.x, a.x, b.x), select(m.y, a.y, b.y)};
}
template <class M, Number A, Number B>
inline auto select(const M& m, const Vec2<A>& a, const Vec2<B>& b) {
    return Vec2<decltype(select(m, a.x, b.x))>{select(m, a.x, b.x), select(m, a.y, b.y)};
}
template <class M, Number A, Number B>
inline auto select(const M& m, const Vec3<A>& a, const Vec3<B>& b) {
    return Vec3<decltype(select(m, a.x, b.x))>{select(m, a.x, b.x), select(m, a.y, b.y), select(m, a.z, b.z)};
}

template <Lanes T>
inline void put(T& to, auto from) {
    to = lift(from);
}
template <Lanes T>
inline void assign(Mask m, T& to, auto from) {
    to = choose(m, lift(from), to);
}
template <Lanes T>
inline void put(Vec2<T>& to, const auto& from) {
    to = lift(from);
}
template <Lanes T>
inline void put(Vec3<T>& to, const auto& from) {
    to = lift(from);
}
template <Lanes T>
inline void put(Vec4<T>& to, const auto& from) {
    to = lift(from);
}
template <Lanes T>
inline void assign(Mask m, Vec2<T>& to, const auto& from) {
    assign(m, to.x, from.x), assign(m, to.y, from.y);
}
template <Lanes T>
inline void assign(Mask m, Vec3<T>& to, const auto& from) {
    assign(m, to.x, from.x), assign(m, to.y, from.y), assign(m, to.z, from.z);
}
template <Lanes T>
inline void assign(Mask m, Vec4<T>& to, const auto& from) {
    assign(m, to.x, from.x), assign(m, to.y, from.y), assign(m, to.z, from.z), assign(m, to.w, from.w);
}
inline void assign(Mask m, Mat4& to, const Mat4& from) {
    for (int i = 0; i < 4; ++i) assign(m, to.column[i], from.column[i]);
}

/// Matrices, the kernel's structures and records differ from lane to lane as they are.
template <class T>
concept Structure = std::is_class_v<T> && !Vector<T>;
template <Structure T>
inline void put(T& to, const T& from) {
    to = from;
}
template <Structure T>
inline const T& lift(const T& x) {
    return x;
}

// -- vectors

template <Number A, Number B>
inline auto vec(A x, B y) {
    if constexpr (std::is_same_v<A, B>)
        return Vec2<A>{x, y};
    else
        return Vec2<decltype(lift(x))>{lift(x), lift(y)};
}
template <Number A, Number B, Number C>
inline auto vec(A x, B y, C z) {
    if constexpr (std::is_same_v<A, B> && std::is_same_v<B, C>)
        return Vec3<A>{x, y, z};
    else
        return Vec3<decltype(lift(x))>{lift(x), lift(y), lift(z)};
}
template <Number A, Number B, Number C, Number D>
inline auto vec(A x, B y, C z, D w) {
    if constexpr (std::is_same_v<A, B> && std::is_same_v<B, C> && std::is_same_v<C, D>)
        return Vec4<A>{x, y, z, w};
    else
        return Vec4<decltype(lift(x))>{lift(x), lift(y), lift(z), lift(w)};
}

/// One function, component by component.
template <Number A>
inline auto each(const Vec2<A>& a, auto f) {
    return Vec2<decltype(f(a.x))>{f(a.x), f(a.y)};
}
template <Number A>
inline auto each(const Vec3<A>& a, auto f) {
    return Vec3<decltype(f(a.x))>{f(a.x), f(a.y), f(a.z)};
}
template <Number A>
inline auto each(const Vec4<A>& a, auto f) {
    return Vec4<decltype(f(a.x))>{f(a.x), f(a.y), f(a.z), f(a.w)};
}
template <Number A, Number B>
inline auto each(const Vec2<A>& a, const Vec2<B>& b, auto f) {
    return Vec2<decltype(f(a.x, b.x))>{f(a.x, b.x), f(a.y, b.y)};
}
template <Number A, Number B>
inline auto each(const Vec3<A>& a, const Vec3<B>& b, auto f) {
    return Vec3<decltype(f(a.x, b.x))>{f(a.x, b.x), f(a.y, b.y), f(a.z, b.z)};
}
template <Number A, Number B>
inline auto each(const Vec4<A>& a, const Vec4<B>& b, auto f) {
    return Vec4<decltype(f(a.x, b.x))>{f(a.x, b.x), f(a.y, b.y), f(a.z, b.z), f(a.w, b.w)};
}
inline auto operator+(const Vector auto& a, const Vector auto& b) { return each(a, b, [](auto p, auto q) { return p + q; }); }
inline auto operator-(const Vector auto& a, const Vector auto& b) { return each(a, b, [](auto p, auto q) { return p - q; }); }
inline auto operator*(const Vector auto& a, const Vector auto& b) { return each(a, b, [](auto p, auto q) { return p * q; }); }
inline auto operator/(const Vector auto& a, const Vector auto& b) { return each(a, b, [](auto p, auto q) { return p / q; }); }
inline auto operator!=(const Vector auto& a, const Vector auto& b) { return each(a, b, [](auto p, auto q) { return p != q; }); }
inline auto operator==(const Vector auto& a, const Vector auto& b) { return each(a, b, [](auto p, auto q) { return p == q; }); }
inline auto operator*(const Vector auto& a, Number auto s) { return each(a, [s](auto p) { return p * s; }); }
inline auto operator-(const Vector auto& a) { return each(a, [](auto p) { return -p; }); }

template <Number A>
inline auto any_of(const Vec3<A>& v) {
    return either(either(v.x, v.y), v.z);
}
template <Number A>
inline auto all_of(const Vec3<A>& v) {
    return both(both(v.x, v.y), v.z);
}

// -- numbers

inline Float to_float(Uint x) { return __builtin_convertvector(x, Float); }
inline Float to_float(Int x) { return __builtin_convertvector(x, Float); }
inline float to_float(std::uint32_t x) { return static_cast<float>(x); }
inline Uint to_uint(Float x) { return (Uint)_mm256_cvttps_epi32((__m256)x); }  // of numbers below 2³¹
inline std::uint32_t to_uint(float x) { return static_cast<std::uint32_t>(x); }
inline Float bits_to_float(Uint x) { return (Float)x; }
inline Uint bits_to_uint(Float x) { return (Uint)x; }

/// Lanes that do not count may divide by 0.
inline Uint divide(Uint a, Uint b) { return a / (b | ((Uint)(b == 0u) & 1u)); }
inline Uint divide(Number auto a, Number auto b) { return divide(lift(a), lift(b)); }
inline Uint modulo(Uint a, Uint b) { return a % (b | ((Uint)(b == 0u) & 1u)); }
inline Uint modulo(Number auto a, Number auto b) { return modulo(lift(a), lift(b)); }

/// By tables: the halves of each byte, turned round, change places, and so do the bytes.
inline Uint reverse_bits(Uint x) {
    const __m256i order = _mm256_setr_epi8(3, 2, 1, 0, 7, 6, 5, 4, 11, 10, 9, 8, 15, 14, 13, 12, 3, 2, 1, 0, 7, 6, 5, 4, 11, 10, 9, 8,
                                           15, 14, 13, 12);
    const __m256i turned = _mm256_setr_epi8(0, 8, 4, 12, 2, 10, 6, 14, 1, 9, 5, 13, 3, 11, 7, 15, 0, 8, 4, 12, 2, 10, 6, 14, 1, 9, 5,
                                            13, 3, 11, 7, 15);
    const __m256i half = _mm256_set1_epi8(15);
    const __m256i bytes = _mm256_shuffle_epi8((__m256i)x, order);
    const __m256i low = _mm256_shuffle_epi8(turned, _mm256_and_si256(bytes, half));
    const __m256i high = _mm256_shuffle_epi8(turned, _mm256_and_si256(_mm256_srli_epi32(bytes, 4), half));
    return (Uint)_mm256_or_si256(_mm256_slli_epi32(low, 4), high);
}
inline Uint reverse_bits(std::uint32_t x) { return reverse_bits(lift(x)); }

// GLSL: y < x ? y : x, and x < y ? y : x.
inline Float min(Float x, Float y) { return (Float)_mm256_min_ps((__m256)y, (__m256)x); }
inline Float max(Float x, Float y) { return (Float)_mm256_max_ps((__m256)y, (__m256)x); }
inline Uint min(Uint x, Uint y) { return (Uint)_mm256_min_epu32((__m256i)x, (__m256i)y); }
inline Uint max(Uint x, Uint y) { return (Uint)_mm256_max_epu32((__m256i)x, (__m256i)y); }
inline float min(float x, float y) { return y < x ? y : x; }
inline float max(float x, float y) { return x < y ? y : x; }
inline std::uint32_t min(std::uint32_t x, std::uint32_t y) { return y < x ? y : x; }
template <Number A, Number B>
    requires(!std::is_same_v<A, B>)
inline auto min(A x, B y) {
    return min(lift(x), lift(y));
}
template <Number A, Number B>
    requires(!std::is_same_v<A, B>)
inline auto max(A x, B y) {
    return max(lift(x), lift(y));
}
inline Float sqrt(Float x) { return (Float)_mm256_sqrt_ps((__m256)x); }
inline float sqrt(float x) { return std::sqrt(x); }
inline auto inversesqrt(Number auto x) { return 1.0f / sqrt(x); }
inline Float abs(Float x) { return (Float)((Uint)x & 0x7fffffffu); }
inline float abs(float x) { return std::abs(x); }
inline Float floor(Float x) { return (Float)_mm256_floor_ps((__m256)x); }
inline Float fract(Float x) { return x - floor(x); }
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
inline Float sin(Float x) { return (Float)_ZGVdN8v_sinf((__m256)x); }
inline Float cos(Float x) { return (Float)_ZGVdN8v_cosf((__m256)x); }
inline Float tan(Float x) { return (Float)_ZGVdN8v_tanf((__m256)x); }
inline Float asin(Float x) { return (Float)_ZGVdN8v_asinf((__m256)x); }
inline Float acos(Float x) { return (Float)_ZGVdN8v_acosf((__m256)x); }
inline Float atan(Float x) { return (Float)_ZGVdN8v_atanf((__m256)x); }
inline Float exp(Float x) { return (Float)_ZGVdN8v_expf((__m256)x); }
inline Float log(Float x) { return (Float)_ZGVdN8v_logf((__m256)x); }
inline Float exp2(Float x) { return (Float)_ZGVdN8v_exp2f((__m256)x); }
inline Float log2(Float x) { return (Float)_ZGVdN8v_log2f((__m256)x); }
inline Float atan2(Number auto y, Number auto x) { return (Float)_ZGVdN8vv_atan2f((__m256)lift(y), (__m256)lift(x)); }
inline Float pow(Number auto x, Number auto y) { return (Float)_ZGVdN8vv_powf((__m256)lift(x), (__m256)lift(y)); }
inline float sin(float x) { return std::sin(x); }
inline float cos(float x) { return std::cos(x); }

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
inline auto reverse_bits(const Vector auto& v) { return each(v, [](auto p) { return reverse_bits(p); }); }
inline auto length(const Vector auto& v) { return sqrt(dot(v, v)); }
inline auto normalize(const Vector auto& v) { return v * inversesqrt(dot(v, v)); }
inline auto abs(const Vector auto& v) { return each(v, [](auto p) { return abs(p); }); }
inline auto sqrt(const Vector auto& v) { return each(v, [](auto p) { return sqrt(p); }); }
inline auto exp(const Vector auto& v) { return each(v, [](auto p) { return exp(p); }); }
inline auto cos(const Vector auto& v) { return each(v, [](auto p) { return cos(p); }); }
inline auto sin(const Vector auto& v) { return each(v, [](auto p) { return sin(p); }); }
inline auto floor(const Vector auto& v) { return each(v, [](auto p) { return floor(p); }); }
inline auto min(const Vector auto& a, const Vector auto& b) { return each(a, b, [](auto p, auto q) { return min(p, q); }); }
inline auto max(const Vector auto& a, const Vector auto& b) { return each(a, b, [](auto p, auto q) { return max(p, q); }); }
inline auto clamp(const Vector auto& x, const Vector auto& low, const Vector auto& high) { return min(max(x, low), high); }
inline auto pow(const Vector auto& a, const Vector auto& b) { return each(a, b, [](auto p, auto q) { return pow(p, q); }); }
inline auto mix(const Vector auto& x, const Vector auto& y, const Vector auto& t) { return x * (each(t, [](auto p) { return 1.0f - p; })) + y * t; }

}  // namespace heliodon::trace::lanes
