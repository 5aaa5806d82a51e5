#include "gpu/command_recording.h"

#include <array>

namespace heliodon::gpu {

CommandRecording::~CommandRecording() {
    for (const VkDescriptorPool descriptors : descriptor_pools)
        vkDestroyDescriptorPool(device.handle(), descriptors, nullptr);
    if (pool) vkDestroyCommandPool(device.handle(), pool, nullptr);
}

Result<void> CommandRecording::open() {
    VkCommandPoolCreateInfo info{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    info.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
    info.queueFamilyIndex = device.queue_family();
    VkResult result = vkCreateCommandPool(device.handle(), &info, nullptr, &pool);
    if (result != VK_SUCCESS) return vulkan_failure("", "cannot create a command pool", result);
    VkCommandBufferAllocateInfo allocate{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
    allocate.commandPool = pool;
    allocate.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    allocate.commandBufferCount = 1;
    result = vkAllocateCommandBuffers(device.handle(), &allocate, &buffer);
    if (result != VK_SUCCESS) return vulkan_failure("", "cannot allocate a command buffer", result);
    return {};
}

Result<void> CommandRecording::begin(std::string name_) {
    name = std::move(name_);
    labels.clear();
    error.reset();
    graphics = nullptr;
    rendering = false;
    for (const VkDescriptorPool descriptors : descriptor_pools) vkResetDescriptorPool(device.handle(), descriptors, 0);
    descriptor_pool = 0;
    vkResetCommandPool(device.handle(), pool, 0);
    VkCommandBufferBeginInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    if (const VkResult result = vkBeginCommandBuffer(buffer, &info); result != VK_SUCCESS)
        return vulkan_failure(name, "cannot begin the command buffer", result);
    device.set_name(VK_OBJECT_TYPE_COMMAND_BUFFER, reinterpret_cast<std::uint64_t>(buffer), name);
    return {};
}

Result<VkDescriptorSet> CommandRecording::allocate(VkDescriptorSetLayout layout) {
    constexpr std::uint32_t sets = 128;
    constexpr std::uint32_t descriptors = 1024;  // of each type
    for (;; ++descriptor_pool) {
        if (descriptor_pool == descriptor_pools.size()) {
            constexpr std::array sizes = {
                VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, descriptors},
                VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, descriptors},
                VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, descriptors},
                VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, descriptors},
                VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, descriptors},
                VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_SAMPLER, descriptors},
            };
            VkDescriptorPoolCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
            info.maxSets = sets;
            info.poolSizeCount = static_cast<std::uint32_t>(sizes.size());
            info.pPoolSizes = sizes.data();
            VkDescriptorPool created = VK_NULL_HANDLE;
            const VkResult result = vkCreateDescriptorPool(device.handle(), &info, nullptr, &created);
            if (result != VK_SUCCESS) return vulkan_failure(name, "cannot create a descriptor pool", result);
            descriptor_pools.push_back(created);
        }
        VkDescriptorSetAllocateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
        info.descriptorPool = descriptor_pools[descriptor_pool];
        info.descriptorSetCount = 1;
        info.pSetLayouts = &layout;
        VkDescriptorSet set = VK_NULL_HANDLE;
        const bool fresh = descriptor_pool + 1 == descriptor_pools.size();
        const VkResult result = vkAllocateDescriptorSets(device.handle(), &info, &set);
        if (result == VK_SUCCESS) return set;
        const bool full = result == VK_ERROR_OUT_OF_POOL_MEMORY || result == VK_ERROR_FRAGMENTED_POOL;
        if (!full || (fresh && descriptor_pool > 4096))
            return vulkan_failure(name, "cannot allocate descriptors", result);
    }
}

}  // namespace heliodon::gpu
