// What translated kernels (tools/lanes) compute with: eight lanes of a number, vectors of them, masks of active lanes.
// Numbers that all lanes share are plain floats and integers; both mix.
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

inline bool any(Mask m) {
    return !_mm256_testz_si256((__m256i)m, (__m256i)m);
}
inline unsigned bits(Mask m) {
    return static_cast<unsigned>(_mm256_movemask_ps((__m256)m));
}
inline Mask as_mask(Mask m) {
    return m;
}
inline Mask as_mask(bool b) {
    return Mask{} - static_cast<int>(b);
}
inline bool both(bool a, bool b) {
    return a && b;
}
inline Mask both(auto a, auto b) {
    return as_mask(a) & as_mask(b);
}
inline bool either(bool a, bool b) {
    return a || b;
}
inline Mask either(auto a, auto b) {
    return as_mask(a) | as_mask(b);
}
inline bool no(bool a) {
    return !a;
}
inline Mask no(Mask a) {
    return ~a;
}
inline bool differ(bool a, bool b) {
    return a != b;
}
inline Mask differ(auto a, auto b) {
    return as_mask(a) ^ as_mask(b);
}

// -- the same number in all lanes

inline Float lift(float x) {
    return Float{} + x;
}
inline Uint lift(std::uint32_t x) {
    return Uint{} + x;
}
inline Int lift(std::int32_t x) {
    return Int{} + x;
}
inline Mask lift(bool x) {
    return as_mask(x);
}
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

inline Float choose(Mask m, Float a, Float b) {
    return (Float)_mm256_blendv_ps((__m256)b, (__m256)a, (__m256)m);
}
inline Uint choose(Mask m, Uint a, Uint b) {
    return (Uint)choose(m, (Float)a, (Float)b);
}
inline Int choose(Mask m, Int a, Int b) {
    return (Int)choose(m, (Float)a, (Float)b);
}

template <Number A, Number B>
inline auto select(Mask m, A a, B b) {
    return choose(m, lift(a), lift(b));
}
template <Number A>
inline A select(bool m, A a, A b) {
    return m ? a : b;
}
template <Number A, Number B>
requires(!std::is_same_v<A, B>) inline auto select(bool m, A a, B b) {
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
inline auto operator+(const Vector auto& a, const Vector auto& b) {
    return each(a, b, [](auto p, auto q) { return p + q; });
}
inline auto operator-(const Vector auto& a, const Vector auto& b) {
    return each(a, b, [](auto p, auto q) { return p - q; });
}
inline auto operator*(const Vector auto& a, const Vector auto& b) {
    return each(a, b, [](auto p, auto q) { return p * q; });
}
inline auto operator/(const Vector auto& a, const Vector auto& b) {
    return each(a, b, [](auto p, auto q) { return p / q; });
}
inline auto operator!=(const Vector auto& a, const Vector auto& b) {
    return each(a, b, [](auto p, auto q) { return p != q; });
}
inline auto operator==(const Vector auto& a, const Vector auto& b) {
    return each(a, b, [](auto p, auto q) { return p == q; });
}
inline auto operator*(const Vector auto& a, Number auto s) {
    return each(a, [s](auto p) { return p * s; });
}
inline auto operator-(const Vector auto& a) {
    return each(a, [](auto p) { return -p; });
}

template <Number A>
inline auto any_of(const Vec3<A>& v) {
    return either(either(v.x, v.y), v.z);
}
template <Number A>
inline auto all_of(const Vec3<A>& v) {
    return both(both(v.x, v.y), v.z);
}

}  // namespace heliodon::trace::lanes
