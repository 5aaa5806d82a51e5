#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "gpu/vulkan.h"

struct VmaAllocation_T;

namespace heliodon::gpu {

class Device;

enum class BufferMemory {
    device,     ///< fastest for the GPU; filled by Device::upload or by shaders
    upload,     ///< mapped, written in order by the CPU and read by the GPU (per-frame constants)
    read_back,  ///< mapped, written by the GPU and read by the CPU
};

struct BufferDescription {
    std::string name;
    VkDeviceSize size = 0;  ///< bytes
    /// On top of storage and transfer both ways, which every buffer may be used for.
    VkBufferUsageFlags usage = 0;
    BufferMemory memory = BufferMemory::device;
};

/// Where an object lies in memory that several share (transient resources of the frame graph).
struct SharedMemory {
    VmaAllocation_T* allocation = nullptr;
    VkDeviceSize offset = 0;
};

/// A buffer and its memory. Destruction waits until the GPU is done with it.
class Buffer {
public:
    [[nodiscard]] static Result<Buffer> create(Device& device, const BufferDescription& description);
    /// In memory that somebody else owns; it must have been sized by memory_requirements().
    [[nodiscard]] static Result<Buffer> create_in(Device& device, const BufferDescription& description,
                                                  SharedMemory memory);
    [[nodiscard]] static VkMemoryRequirements memory_requirements(const Device& device,
                                                                  const BufferDescription& description);
    Buffer() = default;
    ~Buffer();
    Buffer(Buffer&& other) noexcept;
    Buffer& operator=(Buffer&& other) noexcept;

    explicit operator bool() const { return handle_ != VK_NULL_HANDLE; }
    [[nodiscard]] VkBuffer handle() const { return handle_; }
    [[nodiscard]] VkDeviceSize size() const { return description_.size; }
    [[nodiscard]] const BufferDescription& description() const { return description_; }
    [[nodiscard]] const std::string& name() const { return description_.name; }
    /// The memory as the CPU sees it; empty unless `upload` or `read_back`.
    [[nodiscard]] std::span<std::byte> mapped() const { return mapped_; }
    /// How commands recorded so far leave it; kept by the frame graph, uploads and read-backs.
    [[nodiscard]] Access state() const { return state_; }
    void set_state(Access state) const { state_ = state; }

private:
    void reset();

    Device* device_ = nullptr;
    VkBuffer handle_ = VK_NULL_HANDLE;
    VmaAllocation_T* allocation_ = nullptr;  // null when the memory is somebody else's
    std::span<std::byte> mapped_;
    BufferDescription description_;
    mutable Access state_;
};

}  // namespace heliodon::gpu
