#pragma once

#include <algorithm>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/image.h"
#include "gpu/instance.h"
#include "gpu/sampler.h"
#include "gpu/vulkan.h"

struct VmaAllocator_T;

namespace heliodon::gpu {

class BindlessTextures;
class Commands;
struct CommandRecording;
class PipelineCache;
class Uploads;

struct DeviceSettings {
    std::string device;                  ///< number or part of a name; empty: the best usable one
    bool swapchain = false;              ///< enable presentation (the instance then needs a window system's extensions)
    std::uint32_t texture_slots = 4096;  ///< of the bindless table
    /// Where compiled pipelines are kept between runs; unset: $XDG_CACHE_HOME/heliodon or ~/.cache/heliodon; empty:
    /// nowhere.
    std::optional<std::filesystem::path> pipeline_cache_directory;
};

/// Extension entry points, null where the extension is absent.
struct ExtensionFunctions {
    PFN_vkSetDebugUtilsObjectNameEXT set_object_name = nullptr;
    PFN_vkCmdBeginDebugUtilsLabelEXT begin_label = nullptr;
    PFN_vkCmdEndDebugUtilsLabelEXT end_label = nullptr;
    PFN_vkCmdPushDescriptorSetKHR push_descriptor_set = nullptr;
};

/// A point on the device's timeline: the work of one submission is complete when the timeline reaches it.
using TimelineValue = std::uint64_t;

struct SubmitSemaphores {
    VkSemaphore wait = VK_NULL_HANDLE;  ///< binary, e.g. "swapchain image acquired"
    VkPipelineStageFlags2 wait_stages = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    VkSemaphore signal = VK_NULL_HANDLE;  ///< binary, e.g. "ready to present"
};

/// A logical device with one graphics and compute queue. Everything made from it refers to it and must
/// be destroyed before it. One thread records and submits; validation messages may come from any.
class Device {
public:
    [[nodiscard]] static Result<std::unique_ptr<Device>> create(std::shared_ptr<Instance> instance,
                                                                const DeviceSettings& settings = {});
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    [[nodiscard]] const DeviceInfo& info() const { return info_; }
    [[nodiscard]] const VkPhysicalDeviceLimits& limits() const { return properties_.limits; }
    [[nodiscard]] const VkPhysicalDeviceProperties& properties() const { return properties_; }
    [[nodiscard]] VkDevice handle() const { return handle_; }
    [[nodiscard]] VkPhysicalDevice physical_device() const { return physical_device_; }
    [[nodiscard]] Instance& instance() const { return *instance_; }
    [[nodiscard]] VkQueue queue() const { return queue_; }
    [[nodiscard]] std::uint32_t queue_family() const { return queue_family_; }
    [[nodiscard]] VmaAllocator_T* allocator() const { return allocator_; }
    [[nodiscard]] const ExtensionFunctions& functions() const { return functions_; }
    [[nodiscard]] std::vector<std::string> validation_messages() const { return instance_->validation_messages(); }

    /// A command buffer ready to record; recycled once its submission is complete.
    [[nodiscard]] Result<Commands> begin_commands(std::string name);
    /// Ends and submits, after all pending uploads. Refuses commands that recorded an error, with that error.
    [[nodiscard]] Result<TimelineValue> submit(Commands commands, const SubmitSemaphores& semaphores = {});
    /// Records, submits and waits: for set-up work and tests.
    [[nodiscard]] Result<void> run(std::string name, const std::function<void(Commands&)>& record);
    [[nodiscard]] Result<void> wait(TimelineValue value);
    [[nodiscard]] Result<void> wait_idle();
    [[nodiscard]] TimelineValue submitted() const { return submitted_; }
    [[nodiscard]] TimelineValue completed() const;

    /// Copies `bytes` now and to the resource before the next submission runs. `buffer` must have been created
    /// with room for them.
    [[nodiscard]] Result<void> upload(const Buffer& buffer, std::span<const std::byte> bytes, VkDeviceSize offset = 0);
    template <class T>
    [[nodiscard]] Result<void> upload(const Buffer& buffer, std::span<const T> values, VkDeviceSize offset = 0) {
        return upload(buffer, std::as_bytes(values), offset);
    }
    /// Fills one mip level of one layer, tightly packed rows; the image then is in SHADER_READ_ONLY_OPTIMAL.
    [[nodiscard]] Result<void> upload(const Image& image, std::span<const std::byte> bytes, std::uint32_t mip = 0,
                                      std::uint32_t layer = 0);
    /// Waits for all work submitted so far and copies back.
    [[nodiscard]] Result<std::vector<std::byte>> read_back(const Buffer& buffer, VkDeviceSize offset = 0,
                                                           VkDeviceSize size = VK_WHOLE_SIZE);
    /// One mip level of one layer, tightly packed; the image's tracked state says its layout and is kept.
    [[nodiscard]] Result<std::vector<std::byte>> read_back(const Image& image, std::uint32_t mip = 0,
                                                           std::uint32_t layer = 0);
    template <class T>
    [[nodiscard]] Result<std::vector<T>> read_back_as(const Buffer& buffer);
    template <class T>
    [[nodiscard]] Result<std::vector<T>> read_back_as(const Image& image, std::uint32_t mip = 0,
                                                      std::uint32_t layer = 0);
    [[nodiscard]] std::uint64_t bytes_uploaded() const;  ///< since creation

    [[nodiscard]] BindlessTextures& textures() const { return *textures_; }
    /// A cached sampler, owned by the device.
    [[nodiscard]] Result<VkSampler> sampler(const SamplerDescription& description);
    [[nodiscard]] VkPipelineCache pipeline_cache() const;

    /// Calls `destroy` once every submission that may use the thing is complete.
    void retire(std::function<void()> destroy);
    void set_name(VkObjectType type, std::uint64_t handle, const std::string& name) const;
    /// Device memory allocated now.
    [[nodiscard]] std::uint64_t memory_bytes() const;

private:
    friend class Uploads;
    friend class Commands;
    struct Retired {
        TimelineValue value = 0;
        std::function<void()> destroy;
    };

    Device();
    [[nodiscard]] Result<void> open(const DeviceSettings& settings);
    [[nodiscard]] Result<void> open_logical_device(bool swapchain);
    void load_extension_functions(bool push_descriptors);
    [[nodiscard]] Result<void> open_allocator(bool memory_budget);
    [[nodiscard]] Result<void> open_timeline();
    [[nodiscard]] Result<TimelineValue> submit_now(Commands commands, const SubmitSemaphores& semaphores);
    void collect(TimelineValue completed);

    std::shared_ptr<Instance> instance_;
    DeviceInfo info_;
    VkPhysicalDevice physical_device_ = VK_NULL_HANDLE;
    VkPhysicalDeviceProperties properties_{};
    VkDevice handle_ = VK_NULL_HANDLE;
    VkQueue queue_ = VK_NULL_HANDLE;
    std::uint32_t queue_family_ = 0;
    VmaAllocator_T* allocator_ = nullptr;
    ExtensionFunctions functions_;
    VkSemaphore timeline_ = VK_NULL_HANDLE;
    TimelineValue submitted_ = 0;
    std::vector<std::unique_ptr<CommandRecording>> recordings_;  // submitted or free
    int open_recordings_ = 0;
    std::deque<Retired> retired_;
    SamplerCache samplers_;
    std::unique_ptr<PipelineCache> pipeline_cache_;
    std::unique_ptr<BindlessTextures> textures_;
    std::unique_ptr<Uploads> uploads_;
};

template <class T>
Result<std::vector<T>> read_values(Result<std::vector<std::byte>> bytes) {
    if (!bytes) return tl::unexpected(bytes.error());
    std::vector<T> values(bytes->size() / sizeof(T));
    std::copy_n(bytes->data(), values.size() * sizeof(T), reinterpret_cast<std::byte*>(values.data()));
    return values;
}
template <class T>
Result<std::vector<T>> Device::read_back_as(const Buffer& buffer) {
    return read_values<T>(read_back(buffer));
}
template <class T>
Result<std::vector<T>> Device::read_back_as(const Image& image, std::uint32_t mip, std::uint32_t layer) {
    return read_values<T>(read_back(image, mip, layer));
}

}  // namespace heliodon::gpu
