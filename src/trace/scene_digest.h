#pragma once

#include <string>

#include "trace/cpu_kernel.h"

namespace heliodon::trace {

/// 16 hexadecimal digits that change with whatever changes the light: vertices, instances, materials, texels, lights,
/// sky. Equal scenes have equal digests in every process; no protection against forgery.
[[nodiscard]] std::string scene_digest(const CpuKernel& kernel);
/// The same of where the camera stands and looks.
[[nodiscard]] std::string camera_digest(const shading::KernelFrame& frame);

}  // namespace heliodon::trace
