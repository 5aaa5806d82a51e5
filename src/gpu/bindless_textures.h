#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "gpu/image.h"
#include "gpu/vulkan.h"

namespace heliodon::gpu {

/// The table of all 2D textures, `layout(set = 1, binding = 0) uniform sampler2D textures[]` in every shader
/// that declares it; Commands binds it by itself. Every free slot holds a white texel. Slots may change while
/// the GPU works, as long as no running shader reads those slots.
class BindlessTextures {
public:
    static constexpr std::uint32_t set_index = 1;

    [[nodiscard]] static Result<std::unique_ptr<BindlessTextures>> create(Device& device, std::uint32_t capacity);
    ~BindlessTextures();
    BindlessTextures(const BindlessTextures&) = delete;
    BindlessTextures& operator=(const BindlessTextures&) = delete;

    /// The slot given; the image must be kept by the caller, in SHADER_READ_ONLY_OPTIMAL when a shader reads it.
    /// Error when the table is full.
    [[nodiscard]] Result<std::uint32_t> add(const Image& image, VkSampler sampler);
    [[nodiscard]] Result<void> replace(std::uint32_t slot, const Image& image, VkSampler sampler);
    /// Puts the default texel back and frees the slot once the GPU is done with it.
    void remove(std::uint32_t slot);

    [[nodiscard]] std::uint32_t capacity() const { return capacity_; }
    [[nodiscard]] std::uint32_t used() const { return used_; }
    [[nodiscard]] VkDescriptorSetLayout layout() const { return layout_; }
    [[nodiscard]] VkDescriptorSet set() const { return set_; }

private:
    explicit BindlessTextures(Device& device) : device_(device) {}
    [[nodiscard]] Result<void> open(std::uint32_t capacity);
    void write(std::uint32_t slot, VkImageView view, VkSampler sampler);

    Device& device_;
    VkDescriptorSetLayout layout_ = VK_NULL_HANDLE;
    VkDescriptorPool pool_ = VK_NULL_HANDLE;
    VkDescriptorSet set_ = VK_NULL_HANDLE;
    Image default_image_;
    VkSampler default_sampler_ = VK_NULL_HANDLE;
    std::uint32_t capacity_ = 0, used_ = 0, next_ = 0;
    std::vector<std::uint32_t> free_;
};

}  // namespace heliodon::gpu
