#pragma once

#include <cstdint>

#include "trace/cpu_kernel.h"
#include "trace/embree_scene.h"

namespace heliodon::trace {

/// In how many directions paths leave their first surface.
struct Branching {
    std::uint32_t bits = 0;  ///< 2^bits directions
    std::uint64_t rays = 0;  ///< that finding out took
    double seconds = 0;      ///< likewise
};

/// The number that gives the least variance × rays, by the variances and rays that a few pilot paths show. They are in no
/// picture; the same scene, camera, size and seed give the same answer.
[[nodiscard]] Branching choose_branching(const CpuKernel& kernel, const EmbreeScene& scene);

}  // namespace heliodon::trace
