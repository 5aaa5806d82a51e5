#include "gpu/buffer.h"

#include <fmt/format.h>

#include <utility>

#include "gpu/device.h"
#include "gpu/memory.h"

namespace heliodon::gpu {
namespace {

VkBufferCreateInfo create_info(const BufferDescription& description) {
    VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
    info.size = description.size;
    info.usage = description.usage | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                 VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    return info;
}

VmaAllocationCreateInfo allocation_info(BufferMemory memory) {
    VmaAllocationCreateInfo info{};
    info.usage = VMA_MEMORY_USAGE_AUTO;
    if (memory == BufferMemory::device) return info;
    info.usage = memory == BufferMemory::upload ? VMA_MEMORY_USAGE_AUTO : VMA_MEMORY_USAGE_AUTO_PREFER_HOST;
    info.requiredFlags = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    info.flags = VMA_ALLOCATION_CREATE_MAPPED_BIT |
                 (memory == BufferMemory::upload ? VMA_ALLOCATION_CREATE_HOST_ACCESS_SEQUENTIAL_WRITE_BIT
                                                 : VMA_ALLOCATION_CREATE_HOST_ACCESS_RANDOM_BIT);
    return info;
}

/// Vulkan forbids even to try to create a larger one.
VkDeviceSize largest_buffer_bytes(const Device& device) {
    VkPhysicalDeviceVulkan13Properties properties13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_PROPERTIES};
    VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2};
    properties.pNext = &properties13;
    vkGetPhysicalDeviceProperties2(device.physical_device(), &properties);
    return properties13.maxBufferSize;
}

}  // namespace

VkMemoryRequirements Buffer::memory_requirements(const Device& device, const BufferDescription& description) {
    const VkBufferCreateInfo info = create_info(description);
    VkDeviceBufferMemoryRequirements query{VK_STRUCTURE_TYPE_DEVICE_BUFFER_MEMORY_REQUIREMENTS};
    query.pCreateInfo = &info;
    VkMemoryRequirements2 requirements{VK_STRUCTURE_TYPE_MEMORY_REQUIREMENTS_2};
    vkGetDeviceBufferMemoryRequirements(device.handle(), &query, &requirements);
    return requirements.memoryRequirements;
}

Result<Buffer> Buffer::create(Device& device, const BufferDescription& description) {
    const std::string where = fmt::format("buffer '{}' of {} bytes", description.name, description.size);
    if (description.size == 0) return fail(where, "expected a size of at least one byte");
    if (const VkDeviceSize largest = largest_buffer_bytes(device); description.size > largest)
        return fail(where, fmt::format("the device allows no buffer of more than {} bytes", largest));
    const VkBufferCreateInfo info = create_info(description);
    const VmaAllocationCreateInfo allocation = allocation_info(description.memory);
    Buffer buffer;
    buffer.device_ = &device;
    buffer.description_ = description;
    VmaAllocationInfo allocated{};
    const VkResult result =
        vmaCreateBuffer(device.allocator(), &info, &allocation, &buffer.handle_, &buffer.allocation_, &allocated);
    if (result != VK_SUCCESS) return vulkan_failure(where, "cannot allocate it", result);
    if (allocated.pMappedData)
        buffer.mapped_ = {static_cast<std::byte*>(allocated.pMappedData), static_cast<std::size_t>(description.size)};
    vmaSetAllocationName(device.allocator(), buffer.allocation_, description.name.c_str());
    device.set_name(VK_OBJECT_TYPE_BUFFER, reinterpret_cast<std::uint64_t>(buffer.handle_), description.name);
    return buffer;
}

Result<Buffer> Buffer::create_in(Device& device, const BufferDescription& description, SharedMemory memory) {
    const std::string where = fmt::format("buffer '{}' of {} bytes", description.name, description.size);
    const VkBufferCreateInfo info = create_info(description);
    Buffer buffer;
    buffer.device_ = &device;
    buffer.description_ = description;
    const VkResult result =
        vmaCreateAliasingBuffer2(device.allocator(), memory.allocation, memory.offset, &info, &buffer.handle_);
    if (result != VK_SUCCESS) return vulkan_failure(where, "cannot place it in shared memory", result);
    device.set_name(VK_OBJECT_TYPE_BUFFER, reinterpret_cast<std::uint64_t>(buffer.handle_), description.name);
    return buffer;
}

Buffer::~Buffer() {
    reset();
}

void Buffer::reset() {
    if (!handle_) return;
    device_->retire(
        [device = device_->handle(), allocator = device_->allocator(), handle = handle_, allocation = allocation_] {
            if (allocation)
                vmaDestroyBuffer(allocator, handle, allocation);
            else
                vkDestroyBuffer(device, handle, nullptr);
        });
    handle_ = VK_NULL_HANDLE;
}

Buffer::Buffer(Buffer&& other) noexcept {
    *this = std::move(other);
}

Buffer& Buffer::operator=(Buffer&& other) noexcept {
    if (this == &other) return *this;
    reset();
    device_ = other.device_;
    handle_ = std::exchange(other.handle_, VK_NULL_HANDLE);
    allocation_ = std::exchange(other.allocation_, nullptr);
    mapped_ = std::exchange(other.mapped_, {});
    description_ = std::move(other.description_);
    state_ = other.state_;
    return *this;
}

}  // namespace heliodon::gpu
