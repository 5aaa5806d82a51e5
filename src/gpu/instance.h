#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "gpu/vulkan.h"

namespace heliodon::gpu {

struct InstanceSettings {
    bool validation = false;  ///< the validation layer with synchronization checks; an error where it is absent
    std::vector<std::string> extensions;  ///< instance extensions that a window system requires; none when headless
};

/// A Vulkan device of this machine and what it offers.
struct DeviceInfo {
    int number = 0;
    std::string name;
    std::string driver;       ///< driver name and version as it describes itself
    std::string api_version;  ///< "1.3.289"
    VkPhysicalDeviceType type = VK_PHYSICAL_DEVICE_TYPE_OTHER;
    bool is_cpu = false;
    bool usable = false;  ///< has everything Device::create requires
    std::string missing;  ///< what it lacks, comma-separated
    bool ray_query = false, ray_tracing_pipeline = false, mesh_shader = false, conservative_rasterization = false;
    float conservative_extra_px = 0;         ///< by which conservative rasterization grows primitives at most, on request
    bool conservative_degenerates = false;   ///< it draws triangles that rounding has left no area, too
    bool geometry_shader = false;
    bool shader_float_atomics = false;  ///< atomicAdd on 32-bit floats in buffers
    bool buffer_int64_atomics = false;  ///< 64-bit integers in shaders, and atomics on them in buffers
    bool push_descriptors = false;
    std::uint64_t memory_bytes = 0;  ///< device-local
};

/// The connection to the Vulkan loader, and the messages of its validation layer.
class Instance {
public:
    /// Error when no loader or no Vulkan 1.3 is installed, or an extension or the layer is missing.
    [[nodiscard]] static Result<std::shared_ptr<Instance>> create(const InstanceSettings& settings = {});
    ~Instance();
    Instance(const Instance&) = delete;
    Instance& operator=(const Instance&) = delete;

    [[nodiscard]] VkInstance handle() const { return handle_; }
    [[nodiscard]] std::vector<DeviceInfo> devices() const;
    /// The device of that number or whose name contains `choice` (any case); empty: the best usable one, discrete
    /// before integrated before CPU. An error lists what there is.
    [[nodiscard]] Result<DeviceInfo> choose(const std::string& choice) const;
    [[nodiscard]] Result<VkPhysicalDevice> physical_device(int number) const;

    [[nodiscard]] bool has_debug_names() const { return debug_names_; }
    /// Warnings and errors of the validation layer so far (empty when it is off). Thread-safe.
    [[nodiscard]] std::vector<std::string> validation_messages() const;
    void add_validation_message(std::string message);

private:
    Instance() = default;

    VkInstance handle_ = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
    bool debug_names_ = false;
    mutable std::mutex messages_mutex_;
    std::vector<std::string> messages_;
};

/// The Vulkan devices of this machine, usable or not.
[[nodiscard]] Result<std::vector<DeviceInfo>> list_devices();

}  // namespace heliodon::gpu
