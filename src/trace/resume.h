#pragma once

#include <map>
#include <optional>
#include <string>

#include "core/image.h"
#include "core/result.h"
#include "trace/adaptive.h"
#include "trace/cpu_kernel.h"
#include "trace/path_tracer.h"
#include "trace/sample_sums.h"

namespace heliodon::trace {

/// All that a picture in the making consists of.
struct Accumulation {
    Blocks blocks;
    SampleSums sums;
    std::optional<AdaptiveSampling> adaptive;
    int done = 0;  ///< samples of its sequence that each pixel still at work has taken

    [[nodiscard]] SamplesTaken taken(int block) const {
        return adaptive ? adaptive->taken(block, done) : SamplesTaken{{done, done}, false};
    }
};

/// What must be the same for samples to go on where others stopped, by name: the first that differs names the
/// mistake best.
using RenderIdentity = std::map<std::string, std::string>;
[[nodiscard]] RenderIdentity render_identity(const CpuKernel& kernel, const PathOptions& options);

/// Adds the state to the picture: layers and attributes whose names begin with `resume.`, exact to the last bit.
void store_state(const Accumulation& accumulation, const RenderIdentity& identity, Picture& picture);

/// Takes it out again into `accumulation`, which is as for a start of this render; an error where it is of another.
[[nodiscard]] Result<void> restore_state(const Picture& picture, const RenderIdentity& identity,
                                         Accumulation& accumulation);

}  // namespace heliodon::trace
