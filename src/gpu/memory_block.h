#pragma once

#include <string>
#include <utility>

#include "gpu/buffer.h"
#include "gpu/vulkan.h"

namespace heliodon::gpu {

/// Device memory that several resources share. Freed once the GPU is done with it; resources in it go first.
class MemoryBlock {
public:
    [[nodiscard]] static Result<MemoryBlock> create(Device& device, const VkMemoryRequirements& requirements,
                                                    const std::string& name);
    MemoryBlock() = default;
    ~MemoryBlock();
    MemoryBlock(MemoryBlock&& other) noexcept { *this = std::move(other); }
    MemoryBlock& operator=(MemoryBlock&& other) noexcept {
        std::swap(device_, other.device_);
        std::swap(allocation_, other.allocation_);
        return *this;
    }
    [[nodiscard]] SharedMemory at(VkDeviceSize offset) const { return {allocation_, offset}; }

private:
    Device* device_ = nullptr;
    VmaAllocation_T* allocation_ = nullptr;
};

}  // namespace heliodon::gpu
