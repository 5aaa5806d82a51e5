#include "gpu/device.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "gpu/bindless_textures.h"
#include "gpu/command_recording.h"
#include "gpu/commands.h"
#include "gpu/device_features.h"
#include "gpu/memory.h"
#include "gpu/pipeline_cache.h"
#include "gpu/uploads.h"

namespace heliodon::gpu {

Device::Device() = default;

Result<std::unique_ptr<Device>> Device::create(std::shared_ptr<Instance> instance, const DeviceSettings& settings) {
    std::unique_ptr<Device> device(new Device());
    device->instance_ = std::move(instance);
    if (auto opened = device->open(settings); !opened) return tl::unexpected(opened.error());
    return device;
}

Result<void> Device::open(const DeviceSettings& settings) {
    auto chosen = instance_->choose(settings.device);
    if (!chosen) return tl::unexpected(chosen.error());
    info_ = std::move(*chosen);
    auto physical = instance_->physical_device(info_.number);
    if (!physical) return tl::unexpected(physical.error());
    physical_device_ = *physical;
    vkGetPhysicalDeviceProperties(physical_device_, &properties_);
    queue_family_ = graphics_queue_family(physical_device_).value_or(0);

    if (auto opened = open_logical_device(settings.swapchain); !opened) return opened;
    if (auto opened = open_timeline(); !opened) return opened;
    pipeline_cache_ =
        std::make_unique<PipelineCache>(*this, settings.pipeline_cache_directory.value_or(default_cache_directory()));
    uploads_ = std::make_unique<Uploads>(*this);
    auto textures = BindlessTextures::create(*this, settings.texture_slots);
    if (!textures) return tl::unexpected(textures.error());
    textures_ = std::move(*textures);
    return {};
}

Result<void> Device::open_logical_device(bool swapchain) {
    const auto available = device_extensions(physical_device_);
    std::vector<const char*> extensions;
    const auto enable = [&](const char* name) {
        const bool present = contains(available, name);
        if (present) extensions.push_back(name);
        return present;
    };
    if (swapchain && !enable(VK_KHR_SWAPCHAIN_EXTENSION_NAME))
        return fail(info_.name, "the device cannot present to a window (VK_KHR_swapchain is missing)");
    const bool push_descriptors = enable(VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME);
    const bool atomic_float = enable(VK_EXT_SHADER_ATOMIC_FLOAT_EXTENSION_NAME);
    const bool memory_budget = enable(VK_EXT_MEMORY_BUDGET_EXTENSION_NAME);
    enable(VK_EXT_CONSERVATIVE_RASTERIZATION_EXTENSION_NAME);
    DeviceFeatures features = features_to_enable(physical_device_, atomic_float);

    const float priority = 1.0f;
    VkDeviceQueueCreateInfo queue{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
    queue.queueFamilyIndex = queue_family_;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    VkDeviceCreateInfo create{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO};
    create.pNext = features.link(atomic_float);
    create.queueCreateInfoCount = 1;
    create.pQueueCreateInfos = &queue;
    create.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
    create.ppEnabledExtensionNames = extensions.data();
    const VkResult result = vkCreateDevice(physical_device_, &create, nullptr, &handle_);
    if (result != VK_SUCCESS) return vulkan_failure(info_.name, "cannot create the device", result);
    vkGetDeviceQueue(handle_, queue_family_, 0, &queue_);

    load_extension_functions(push_descriptors);
    return open_allocator(memory_budget);
}

void Device::load_extension_functions(bool push_descriptors) {
    if (instance_->has_debug_names()) {
        const auto load = [&](const char* name) { return vkGetInstanceProcAddr(instance_->handle(), name); };
        functions_.set_object_name =
            reinterpret_cast<PFN_vkSetDebugUtilsObjectNameEXT>(load("vkSetDebugUtilsObjectNameEXT"));
        functions_.begin_label =
            reinterpret_cast<PFN_vkCmdBeginDebugUtilsLabelEXT>(load("vkCmdBeginDebugUtilsLabelEXT"));
        functions_.end_label = reinterpret_cast<PFN_vkCmdEndDebugUtilsLabelEXT>(load("vkCmdEndDebugUtilsLabelEXT"));
    }
    if (push_descriptors)
        functions_.push_descriptor_set =
            reinterpret_cast<PFN_vkCmdPushDescriptorSetKHR>(vkGetDeviceProcAddr(handle_, "vkCmdPushDescriptorSetKHR"));
}

Result<void> Device::open_allocator(bool memory_budget) {
    VmaVulkanFunctions entry_points{};
    entry_points.vkGetInstanceProcAddr = vkGetInstanceProcAddr;
    entry_points.vkGetDeviceProcAddr = vkGetDeviceProcAddr;
    VmaAllocatorCreateInfo allocator{};
    allocator.flags = memory_budget ? VMA_ALLOCATOR_CREATE_EXT_MEMORY_BUDGET_BIT : 0;
    allocator.physicalDevice = physical_device_;
    allocator.device = handle_;
    allocator.instance = instance_->handle();
    allocator.pVulkanFunctions = &entry_points;
    allocator.vulkanApiVersion = VK_API_VERSION_1_3;
    const VkResult result = vmaCreateAllocator(&allocator, &allocator_);
    if (result != VK_SUCCESS) return vulkan_failure(info_.name, "cannot create the memory allocator", result);
    return {};
}

Result<void> Device::open_timeline() {
    VkSemaphoreTypeCreateInfo timeline{VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO};
    timeline.semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE;
    VkSemaphoreCreateInfo semaphore{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    semaphore.pNext = &timeline;
    const VkResult result = vkCreateSemaphore(handle_, &semaphore, nullptr, &timeline_);
    if (result != VK_SUCCESS) return vulkan_failure(info_.name, "cannot create the timeline", result);
    set_name(VK_OBJECT_TYPE_SEMAPHORE, reinterpret_cast<std::uint64_t>(timeline_), "timeline");
    return {};
}

Device::~Device() {
    if (!handle_) return;
    vkDeviceWaitIdle(handle_);
    const auto all = std::numeric_limits<TimelineValue>::max();
    collect(all);
    textures_.reset();
    uploads_.reset();
    collect(all);
    pipeline_cache_.reset();
    recordings_.clear();
    for (const auto& sampler : samplers_) vkDestroySampler(handle_, sampler.second, nullptr);
    vkDestroySemaphore(handle_, timeline_, nullptr);
    if (allocator_) vmaDestroyAllocator(allocator_);
    vkDestroyDevice(handle_, nullptr);
}

Result<Commands> Device::begin_commands(std::string name) {
    const TimelineValue done = completed();
    collect(done);
    std::unique_ptr<CommandRecording> recording;
    const auto free = std::ranges::find_if(recordings_, [&](const auto& r) { return r->value <= done; });
    if (free != recordings_.end()) {
        recording = std::move(*free);
        recordings_.erase(free);
    } else {
        recording = std::make_unique<CommandRecording>(*this);
        if (auto opened = recording->open(); !opened) return tl::unexpected(opened.error());
    }
    if (auto begun = recording->begin(std::move(name)); !begun) return tl::unexpected(begun.error());
    ++open_recordings_;
    return Commands(std::move(recording));
}

Result<TimelineValue> Device::submit(Commands commands, const SubmitSemaphores& semaphores) {
    if (commands.error()) return tl::unexpected(*commands.error());
    if (auto flushed = uploads_->flush(); !flushed) return tl::unexpected(flushed.error());
    return submit_now(std::move(commands), semaphores);
}

Result<TimelineValue> Device::submit_now(Commands commands, const SubmitSemaphores& semaphores) {
    CommandRecording& recording = *commands.recording_;
    if (recording.error) return tl::unexpected(*recording.error);
    if (recording.rendering) return fail(recording.name, "begin_rendering without end_rendering");
    VkResult result = vkEndCommandBuffer(recording.buffer);
    if (result != VK_SUCCESS) return vulkan_failure(recording.name, "cannot end the command buffer", result);

    VkCommandBufferSubmitInfo buffer{VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO};
    buffer.commandBuffer = recording.buffer;
    VkSemaphoreSubmitInfo wait{VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO};
    wait.semaphore = semaphores.wait;
    wait.stageMask = semaphores.wait_stages;
    VkSemaphoreSubmitInfo signals[2]{{VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO},
                                     {VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO}};
    signals[0].semaphore = timeline_;
    signals[0].value = submitted_ + 1;
    signals[0].stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    signals[1].semaphore = semaphores.signal;
    signals[1].stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    VkSubmitInfo2 submit{VK_STRUCTURE_TYPE_SUBMIT_INFO_2};
    submit.waitSemaphoreInfoCount = semaphores.wait ? 1 : 0;
    submit.pWaitSemaphoreInfos = &wait;
    submit.commandBufferInfoCount = 1;
    submit.pCommandBufferInfos = &buffer;
    submit.signalSemaphoreInfoCount = semaphores.signal ? 2 : 1;
    submit.pSignalSemaphoreInfos = signals;
    result = vkQueueSubmit2(queue_, 1, &submit, VK_NULL_HANDLE);
    if (result != VK_SUCCESS) return vulkan_failure(recording.name, "cannot submit", result);
    recording.value = ++submitted_;
    return submitted_;
}

Result<void> Device::run(std::string name, const std::function<void(Commands&)>& record) {
    auto commands = begin_commands(std::move(name));
    if (!commands) return tl::unexpected(commands.error());
    record(*commands);
    auto value = submit(std::move(*commands));
    if (!value) return tl::unexpected(value.error());
    return wait(*value);
}

TimelineValue Device::completed() const {
    TimelineValue value = 0;
    vkGetSemaphoreCounterValue(handle_, timeline_, &value);
    return value;
}

Result<void> Device::wait(TimelineValue value) {
    if (value > submitted_)
        return fail(info_.name, fmt::format("waiting for submission {} of {} would never end", value, submitted_));
    VkSemaphoreWaitInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO};
    info.semaphoreCount = 1;
    info.pSemaphores = &timeline_;
    info.pValues = &value;
    const VkResult result = vkWaitSemaphores(handle_, &info, std::numeric_limits<std::uint64_t>::max());
    if (result != VK_SUCCESS) return vulkan_failure(info_.name, "cannot wait for the device", result);
    const bool idle = value == submitted_ && open_recordings_ == 0;
    collect(idle ? std::numeric_limits<TimelineValue>::max() : value);
    return {};
}

Result<void> Device::wait_idle() {
    if (auto flushed = uploads_->flush(); !flushed) return flushed;
    return wait(submitted_);
}

Result<void> Device::upload(const Buffer& buffer, std::span<const std::byte> bytes, VkDeviceSize offset) {
    return uploads_->add(buffer, bytes, offset);
}

Result<void> Device::upload(const Image& image, std::span<const std::byte> bytes, std::uint32_t mip,
                            std::uint32_t layer) {
    return uploads_->add(image, bytes, mip, layer);
}

std::uint64_t Device::bytes_uploaded() const {
    return uploads_->total_bytes();
}

VkPipelineCache Device::pipeline_cache() const {
    return pipeline_cache_->handle();
}

void Device::retire(std::function<void()> destroy) {
    // Commands being recorded may use the thing too; each of them will be one more submission.
    const TimelineValue value = submitted_ + static_cast<TimelineValue>(open_recordings_);
    retired_.push_back({value, std::move(destroy)});
    if (value <= completed()) collect(value);
}

void Device::collect(TimelineValue completed) {
    // Destroying one thing may retire others, so each leaves the list before it is called.
    while (true) {
        const auto done = std::ranges::find_if(retired_, [&](const Retired& r) { return r.value <= completed; });
        if (done == retired_.end()) return;
        const std::function<void()> destroy = std::move(done->destroy);
        retired_.erase(done);
        destroy();
    }
}

void Device::set_name(VkObjectType type, std::uint64_t handle, const std::string& name) const {
    if (!functions_.set_object_name || name.empty()) return;
    VkDebugUtilsObjectNameInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT};
    info.objectType = type;
    info.objectHandle = handle;
    info.pObjectName = name.c_str();
    functions_.set_object_name(handle_, &info);
}

std::uint64_t Device::memory_bytes() const {
    VmaBudget budgets[VK_MAX_MEMORY_HEAPS]{};
    vmaGetHeapBudgets(allocator_, budgets);
    VkPhysicalDeviceMemoryProperties memory{};
    vkGetPhysicalDeviceMemoryProperties(physical_device_, &memory);
    std::uint64_t bytes = 0;
    for (std::uint32_t heap = 0; heap < memory.memoryHeapCount; ++heap)
        if (memory.memoryHeaps[heap].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT)
            bytes += budgets[heap].statistics.allocationBytes;
    return bytes;
}

}  // namespace heliodon::gpu
