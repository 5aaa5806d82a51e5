// The two-language subset: what C++ (with GLM) and GLSL need so that one header compiles in both.
//  - free functions marked SHADING_FN, structs of float/vec/uint/int members, no pointers, no recursion,
//    no templates, no constructors for structs (assign members), no swizzles (GLM has none here): use
//    vec3(v) to shorten a vec4 and .x .y .z .w for single components;
//  - float literals with a decimal point and an f: 0.5f (never 0.5: that is a double in C++);
//  - SHADING_OUT(T) / SHADING_INOUT(T) for reference parameters; SHADING_IN(T) for large structs that are only
//    read: a parameter, or a local that names what a fetch returns, without a copy in C++;
//  - constants as SHADING_CONST float name = …;
//  - no name that GLSL reserves: sample, flat, smooth, input, output, common, filter, active, half, …;
//  - a header whose functions fetch (material_fetch.h, path_kernel.h) opens no namespace and holds no
//    constants: C++ includes it inside the struct whose members answer the fetches.
#ifndef HELIODON_SHADING_LANGUAGE_H
#define HELIODON_SHADING_LANGUAGE_H

#ifdef __cplusplus

#include <cmath>
#include <cstdint>

#include "core/math.h"

#define SHADING_BEGIN namespace heliodon::shading {
#define SHADING_END }
#define SHADING_FN inline
#define SHADING_IN(T) const T&
#define SHADING_OUT(T) T&
#define SHADING_INOUT(T) T&
#define SHADING_CONST inline constexpr

namespace heliodon::shading {
using glm::vec2;
using glm::vec3;
using glm::vec4;
using glm::ivec2;
using glm::ivec3;
using glm::ivec4;
using glm::uvec2;
using glm::uvec3;
using glm::uvec4;
using glm::mat2;
using glm::mat3;
using glm::mat4;
using uint = std::uint32_t;
using glm::abs;
// Not templates, and so preferred: GLM's compares where clearing a bit will do.
inline float abs(float x) { return std::fabs(x); }
inline vec2 abs(const vec2& v) { return {std::fabs(v.x), std::fabs(v.y)}; }
inline vec3 abs(const vec3& v) { return {std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)}; }
using glm::acos;
using glm::asin;
using glm::atan;
using glm::clamp;
using glm::cos;
using glm::cross;
using glm::dot;
using glm::exp;
using glm::exp2;
using glm::floor;
using glm::fract;
using glm::inversesqrt;
using glm::length;
using glm::log;
using glm::log2;
using glm::max;
using glm::min;
using glm::mix;
using glm::mod;
using glm::normalize;
using glm::pow;
using glm::reflect;
using glm::refract;
using glm::sign;
using glm::sin;
using glm::smoothstep;
using glm::sqrt;
using glm::step;
using glm::tan;
using glm::transpose;
using glm::uintBitsToFloat;
using glm::floatBitsToUint;
}  // namespace heliodon::shading

#else

#define SHADING_BEGIN
#define SHADING_END
#define SHADING_FN
#define SHADING_IN(T) T
#define SHADING_OUT(T) out T
#define SHADING_INOUT(T) inout T
#define SHADING_CONST const

#endif
#endif
