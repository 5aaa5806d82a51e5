#include "gpu/memory_block.h"

#include <fmt/format.h>

#include "gpu/device.h"
#include "gpu/memory.h"

namespace heliodon::gpu {

Result<MemoryBlock> MemoryBlock::create(Device& device, const VkMemoryRequirements& requirements,
                                        const std::string& name) {
    VmaAllocationCreateInfo info{};
    info.preferredFlags = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
    info.flags = VMA_ALLOCATION_CREATE_CAN_ALIAS_BIT;
    MemoryBlock block;
    block.device_ = &device;
    const VkResult result = vmaAllocateMemory(device.allocator(), &requirements, &info, &block.allocation_, nullptr);
    if (result != VK_SUCCESS)
        return vulkan_failure(fmt::format("{} of {} bytes", name, requirements.size), "cannot allocate them", result);
    vmaSetAllocationName(device.allocator(), block.allocation_, name.c_str());
    return block;
}

MemoryBlock::~MemoryBlock() {
    if (!allocation_) return;
    device_->retire(
        [allocator = device_->allocator(), allocation = allocation_] { vmaFreeMemory(allocator, allocation); });
}

}  // namespace heliodon::gpu
