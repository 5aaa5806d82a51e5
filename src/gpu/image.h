#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/vulkan.h"

namespace heliodon::gpu {

enum class ImageShape { flat, volume, cube };

struct ImageDescription {
    std::string name;
    VkFormat format = VK_FORMAT_R8G8B8A8_UNORM;
    VkExtent3D extent{1, 1, 1};
    std::uint32_t mips = 1;
    std::uint32_t layers = 1;  ///< a cube has 6 (or 6 n: an array of cubes)
    ImageShape shape = ImageShape::flat;
    /// On top of sampled and transfer both ways, which every image may be used for.
    VkImageUsageFlags usage = 0;
    VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
};

class Image;

inline constexpr std::uint32_t all_remaining = ~0u;

/// A part of an image: a value, made on the spot; Image keeps the Vulkan views behind it.
struct ImageView {
    const Image* image = nullptr;
    std::uint32_t base_mip = 0, mips = all_remaining;
    std::uint32_t base_layer = 0, layers = all_remaining;
};

/// An image and its memory. Destruction waits until the GPU is done with it.
class Image {
public:
    [[nodiscard]] static Result<Image> create(Device& device, const ImageDescription& description);
    /// In memory that somebody else owns; it must have been sized by memory_requirements().
    [[nodiscard]] static Result<Image> create_in(Device& device, const ImageDescription& description,
                                                 SharedMemory memory);
    /// An image that somebody else owns (a swapchain's).
    [[nodiscard]] static Image borrow(Device& device, const ImageDescription& description, VkImage handle);
    [[nodiscard]] static VkMemoryRequirements memory_requirements(const Device& device,
                                                                  const ImageDescription& description);
    Image() = default;
    ~Image();
    Image(Image&& other) noexcept;
    Image& operator=(Image&& other) noexcept;

    explicit operator bool() const { return handle_ != VK_NULL_HANDLE; }
    [[nodiscard]] VkImage handle() const { return handle_; }
    [[nodiscard]] const ImageDescription& description() const { return description_; }
    [[nodiscard]] const std::string& name() const { return description_.name; }
    [[nodiscard]] VkFormat format() const { return description_.format; }
    [[nodiscard]] VkExtent3D extent(std::uint32_t mip = 0) const;
    [[nodiscard]] std::uint32_t mips() const { return description_.mips; }
    [[nodiscard]] std::uint32_t layers() const { return description_.layers; }

    [[nodiscard]] ImageView mip(std::uint32_t level) const { return {this, level, 1, 0, all_remaining}; }
    [[nodiscard]] ImageView layer(std::uint32_t index) const { return {this, 0, all_remaining, index, 1}; }
    /// The Vulkan view of a part, made on first use and kept. `type` VK_IMAGE_VIEW_TYPE_MAX_ENUM: the natural one
    /// for the shape and number of layers.
    [[nodiscard]] Result<VkImageView> view(const ImageView& part,
                                           VkImageViewType type = VK_IMAGE_VIEW_TYPE_MAX_ENUM) const;

    /// How commands recorded so far leave it (all its parts alike); kept by the frame graph, uploads and read-backs.
    [[nodiscard]] Access state() const { return state_; }
    void set_state(Access state) const { state_ = state; }

private:
    struct CachedView {
        ImageView part;
        VkImageViewType type;
        VkImageView handle;
    };
    void reset();

    Device* device_ = nullptr;
    VkImage handle_ = VK_NULL_HANDLE;
    VmaAllocation_T* allocation_ = nullptr;  // null when the memory is somebody else's
    bool borrowed_ = false;
    ImageDescription description_;
    mutable std::vector<CachedView> views_;
    mutable Access state_;
};

}  // namespace heliodon::gpu
