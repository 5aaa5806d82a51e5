#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "convert/flat_scene.h"

namespace heliodon::realtime {

/// Which instances moved, appeared, vanished or changed their geometry or material, and when: what has never changed
/// since the scene was loaded may be voxelized once. Lights, cameras, sensors and the sky do not count.
class MovingInstances {
public:
    /// Follows one update of `scene`.
    void follow(const convert::FlatScene& scene, const convert::FlatChanges& changes);

    /// Goes up with every update that changed a surface.
    [[nodiscard]] std::uint64_t revision() const { return revision_; }
    /// The revision that loaded the scene, or rebuilt it because its journal was outrun: nothing has moved since.
    [[nodiscard]] std::uint64_t loaded_revision() const { return loaded_revision_; }
    /// By instance: the revision that changed it last.
    [[nodiscard]] std::span<const std::uint64_t> last_changes() const { return last_changes_; }
    /// Whether an instance changed since the scene was loaded.
    [[nodiscard]] bool moves(std::uint32_t instance) const { return last_changes_[instance] > loaded_revision_; }
    /// The instances that changed after `revision`, ascending, hidden ones too: they may have been seen before.
    [[nodiscard]] std::vector<std::uint32_t> changed_since(std::uint64_t revision) const;

private:
    std::uint64_t revision_ = 0, loaded_revision_ = 0;
    std::vector<std::uint64_t> last_changes_;
    std::vector<shading::InstanceData> instances_;  // as they last were: a rewritten record may be the same
    std::vector<shading::MaterialData> materials_;
};

}  // namespace heliodon::realtime
