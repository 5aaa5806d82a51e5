#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>

#include "gpu/vulkan.h"

namespace heliodon::gpu {

class Device;

/// $XDG_CACHE_HOME/heliodon or ~/.cache/heliodon; empty when neither is known.
[[nodiscard]] std::filesystem::path default_cache_directory();

/// Compiled pipelines, kept in a file of their device and driver. A damaged file is ignored, and failing to
/// write one is not an error: pipelines are then compiled again.
class PipelineCache {
public:
    PipelineCache(const Device& device, const std::filesystem::path& directory);
    ~PipelineCache();
    PipelineCache(const PipelineCache&) = delete;
    PipelineCache& operator=(const PipelineCache&) = delete;

    [[nodiscard]] VkPipelineCache handle() const { return handle_; }
    [[nodiscard]] const std::filesystem::path& file() const { return file_; }
    /// Bytes taken over from the file.
    [[nodiscard]] std::size_t loaded_bytes() const { return loaded_bytes_; }
    void save() const noexcept;

private:
    const Device& device_;
    VkPipelineCache handle_ = VK_NULL_HANDLE;
    std::filesystem::path file_;
    std::size_t loaded_bytes_ = 0;
};

}  // namespace heliodon::gpu
