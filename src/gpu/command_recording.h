#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gpu/device.h"
#include "gpu/vulkan.h"

namespace heliodon::gpu {

class GraphicsPipeline;

/// A command buffer with all that it owns while it is recorded and runs; recycled by Device.
struct CommandRecording {
    explicit CommandRecording(Device& device_) : device(device_) {}
    ~CommandRecording();
    CommandRecording(const CommandRecording&) = delete;
    CommandRecording& operator=(const CommandRecording&) = delete;

    [[nodiscard]] Result<void> open();
    [[nodiscard]] Result<void> begin(std::string name_);
    /// A set of `layout` that lives as long as this recording runs (for devices without push descriptors).
    [[nodiscard]] Result<VkDescriptorSet> allocate(VkDescriptorSetLayout layout);

    Device& device;
    VkCommandPool pool = VK_NULL_HANDLE;
    VkCommandBuffer buffer = VK_NULL_HANDLE;
    std::vector<VkDescriptorPool> descriptor_pools;
    std::size_t descriptor_pool = 0;  // the one in use
    std::string name;
    std::vector<std::string> labels;  // open ones, innermost last
    std::optional<Error> error;
    const GraphicsPipeline* graphics = nullptr;  // bound for draws; null after an error
    bool rendering = false;
    TimelineValue value = 0;  // of its last submission
};

}  // namespace heliodon::gpu
