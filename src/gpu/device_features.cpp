#include "gpu/device_features.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace heliodon::gpu {
namespace {

template <class Features>
struct Feature {
    const char* name;
    VkBool32 Features::*member;
};
using Core = VkPhysicalDeviceFeatures;
using Vulkan11 = VkPhysicalDeviceVulkan11Features;
using Vulkan12 = VkPhysicalDeviceVulkan12Features;
using Vulkan13 = VkPhysicalDeviceVulkan13Features;

constexpr std::array required_core = {
    Feature<Core>{"multiDrawIndirect", &Core::multiDrawIndirect},
    Feature<Core>{"drawIndirectFirstInstance", &Core::drawIndirectFirstInstance},
    Feature<Core>{"imageCubeArray", &Core::imageCubeArray},
    Feature<Core>{"independentBlend", &Core::independentBlend},
    Feature<Core>{"fragmentStoresAndAtomics", &Core::fragmentStoresAndAtomics},
    Feature<Core>{"shaderStorageImageWriteWithoutFormat", &Core::shaderStorageImageWriteWithoutFormat},
    Feature<Core>{"shaderStorageImageExtendedFormats", &Core::shaderStorageImageExtendedFormats},
    Feature<Core>{"shaderImageGatherExtended", &Core::shaderImageGatherExtended},
};
constexpr std::array required_vulkan11 = {
    Feature<Vulkan11>{"shaderDrawParameters", &Vulkan11::shaderDrawParameters},
    Feature<Vulkan11>{"multiview", &Vulkan11::multiview},
};
constexpr std::array required_vulkan12 = {
    Feature<Vulkan12>{"descriptorIndexing", &Vulkan12::descriptorIndexing},
    Feature<Vulkan12>{"runtimeDescriptorArray", &Vulkan12::runtimeDescriptorArray},
    Feature<Vulkan12>{"descriptorBindingPartiallyBound", &Vulkan12::descriptorBindingPartiallyBound},
    Feature<Vulkan12>{"descriptorBindingSampledImageUpdateAfterBind",
                      &Vulkan12::descriptorBindingSampledImageUpdateAfterBind},
    Feature<Vulkan12>{"descriptorBindingUpdateUnusedWhilePending",
                      &Vulkan12::descriptorBindingUpdateUnusedWhilePending},
    Feature<Vulkan12>{"shaderSampledImageArrayNonUniformIndexing",
                      &Vulkan12::shaderSampledImageArrayNonUniformIndexing},
    Feature<Vulkan12>{"drawIndirectCount", &Vulkan12::drawIndirectCount},
    Feature<Vulkan12>{"scalarBlockLayout", &Vulkan12::scalarBlockLayout},
    Feature<Vulkan12>{"timelineSemaphore", &Vulkan12::timelineSemaphore},
    Feature<Vulkan12>{"hostQueryReset", &Vulkan12::hostQueryReset},
};
constexpr std::array required_vulkan13 = {
    Feature<Vulkan13>{"dynamicRendering", &Vulkan13::dynamicRendering},
    Feature<Vulkan13>{"synchronization2", &Vulkan13::synchronization2},
    Feature<Vulkan13>{"maintenance4", &Vulkan13::maintenance4},
};
constexpr std::array optional_core = {
    Feature<Core>{"samplerAnisotropy", &Core::samplerAnisotropy},
    Feature<Core>{"geometryShader", &Core::geometryShader},
    Feature<Core>{"depthClamp", &Core::depthClamp},
    Feature<Core>{"fillModeNonSolid", &Core::fillModeNonSolid},
    Feature<Core>{"vertexPipelineStoresAndAtomics", &Core::vertexPipelineStoresAndAtomics},
    Feature<Core>{"shaderStorageImageReadWithoutFormat", &Core::shaderStorageImageReadWithoutFormat},
    Feature<Core>{"shaderInt64", &Core::shaderInt64},
    Feature<Core>{"shaderInt16", &Core::shaderInt16},
    Feature<Core>{"textureCompressionBC", &Core::textureCompressionBC},
    Feature<Core>{"sampleRateShading", &Core::sampleRateShading},
};
constexpr std::array optional_vulkan11 = {
    Feature<Vulkan11>{"storageBuffer16BitAccess", &Vulkan11::storageBuffer16BitAccess},
};
constexpr std::array optional_vulkan12 = {
    Feature<Vulkan12>{"samplerFilterMinmax", &Vulkan12::samplerFilterMinmax},
    Feature<Vulkan12>{"shaderFloat16", &Vulkan12::shaderFloat16},
    Feature<Vulkan12>{"storageBuffer8BitAccess", &Vulkan12::storageBuffer8BitAccess},
    Feature<Vulkan12>{"shaderBufferInt64Atomics", &Vulkan12::shaderBufferInt64Atomics},
    Feature<Vulkan12>{"shaderStorageBufferArrayNonUniformIndexing",
                      &Vulkan12::shaderStorageBufferArrayNonUniformIndexing},
};
constexpr std::array optional_vulkan13 = {
    Feature<Vulkan13>{"shaderDemoteToHelperInvocation", &Vulkan13::shaderDemoteToHelperInvocation},
    Feature<Vulkan13>{"subgroupSizeControl", &Vulkan13::subgroupSizeControl},
};

template <class Features, std::size_t N>
void list_missing(const Features& have, const std::array<Feature<Features>, N>& wanted, std::string& missing) {
    for (const auto& feature : wanted)
        if (!(have.*feature.member)) missing += (missing.empty() ? "" : ", ") + std::string(feature.name);
}

template <class Features, std::size_t N>
void take(const Features& have, const std::array<Feature<Features>, N>& wanted, Features& enabled) {
    for (const auto& feature : wanted) enabled.*feature.member = have.*feature.member;
}

std::string version_text(std::uint32_t version) {
    return fmt::format("{}.{}.{}", VK_API_VERSION_MAJOR(version), VK_API_VERSION_MINOR(version),
                       VK_API_VERSION_PATCH(version));
}

std::string find_missing(VkPhysicalDevice device) {
    DeviceFeatures have;
    vkGetPhysicalDeviceFeatures2(device, have.link(false));
    std::string missing;
    list_missing(have.core.features, required_core, missing);
    list_missing(have.vulkan11, required_vulkan11, missing);
    list_missing(have.vulkan12, required_vulkan12, missing);
    list_missing(have.vulkan13, required_vulkan13, missing);
    if (!graphics_queue_family(device))
        missing += std::string(missing.empty() ? "" : ", ") + "a queue for graphics, compute and timestamps";
    return missing;
}

bool has_int64_atomics(VkPhysicalDevice device) {
    DeviceFeatures have;
    vkGetPhysicalDeviceFeatures2(device, have.link(false));
    return have.core.features.shaderInt64 && have.vulkan12.shaderBufferInt64Atomics;
}

bool has_float_atomics(VkPhysicalDevice device) {
    DeviceFeatures have;
    vkGetPhysicalDeviceFeatures2(device, have.link(true));
    return have.atomic_float.shaderBufferFloat32AtomicAdd;
}

}  // namespace

VkPhysicalDeviceFeatures2* DeviceFeatures::link(bool with_atomic_float) {
    core.pNext = &vulkan11;
    vulkan11.pNext = &vulkan12;
    vulkan12.pNext = &vulkan13;
    vulkan13.pNext = with_atomic_float ? &atomic_float : nullptr;
    return &core;
}

std::vector<std::string> device_extensions(VkPhysicalDevice device) {
    std::uint32_t count = 0;
    vkEnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr);
    std::vector<VkExtensionProperties> properties(count);
    vkEnumerateDeviceExtensionProperties(device, nullptr, &count, properties.data());
    std::vector<std::string> names;
    for (const auto& property : properties) names.emplace_back(property.extensionName);
    return names;
}

bool contains(const std::vector<std::string>& names, const char* name) {
    return std::ranges::find(names, name) != names.end();
}

std::optional<std::uint32_t> graphics_queue_family(VkPhysicalDevice device) {
    std::uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
    constexpr VkQueueFlags needed = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    for (std::uint32_t index = 0; index < count; ++index)
        if ((families[index].queueFlags & needed) == needed && families[index].timestampValidBits > 0) return index;
    return std::nullopt;
}

DeviceInfo describe(VkPhysicalDevice device, int number) {
    VkPhysicalDeviceDriverProperties driver{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
    VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2};
    vkGetPhysicalDeviceProperties(device, &properties.properties);
    const std::uint32_t version = properties.properties.apiVersion;
    if (version >= VK_API_VERSION_1_2) {
        properties.pNext = &driver;
        vkGetPhysicalDeviceProperties2(device, &properties);
    }
    DeviceInfo info;
    info.number = number;
    info.name = properties.properties.deviceName;
    info.driver = driver.driverName[0] ? fmt::format("{} {}", driver.driverName, driver.driverInfo)
                                       : version_text(properties.properties.driverVersion);
    info.api_version = version_text(version);
    info.type = properties.properties.deviceType;
    info.is_cpu = info.type == VK_PHYSICAL_DEVICE_TYPE_CPU;

    const auto extensions = device_extensions(device);
    info.ray_query = contains(extensions, VK_KHR_RAY_QUERY_EXTENSION_NAME);
    info.ray_tracing_pipeline = contains(extensions, VK_KHR_RAY_TRACING_PIPELINE_EXTENSION_NAME);
    info.mesh_shader = contains(extensions, VK_EXT_MESH_SHADER_EXTENSION_NAME);
    info.conservative_rasterization = contains(extensions, VK_EXT_CONSERVATIVE_RASTERIZATION_EXTENSION_NAME);
    if (info.conservative_rasterization && version >= VK_API_VERSION_1_1) {
        VkPhysicalDeviceConservativeRasterizationPropertiesEXT conservative{
            VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_CONSERVATIVE_RASTERIZATION_PROPERTIES_EXT};
        properties.pNext = &conservative;
        vkGetPhysicalDeviceProperties2(device, &properties);
        info.conservative_extra_px = conservative.maxExtraPrimitiveOverestimationSize;
        info.conservative_degenerates = conservative.degenerateTrianglesRasterized;
    }
    VkPhysicalDeviceFeatures features{};
    vkGetPhysicalDeviceFeatures(device, &features);
    info.geometry_shader = features.geometryShader;
    info.push_descriptors = contains(extensions, VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME);
    info.buffer_int64_atomics = version >= VK_API_VERSION_1_3 && has_int64_atomics(device);
    info.shader_float_atomics =
        contains(extensions, VK_EXT_SHADER_ATOMIC_FLOAT_EXTENSION_NAME) && has_float_atomics(device);

    VkPhysicalDeviceMemoryProperties memory{};
    vkGetPhysicalDeviceMemoryProperties(device, &memory);
    for (std::uint32_t heap = 0; heap < memory.memoryHeapCount; ++heap)
        if (memory.memoryHeaps[heap].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT)
            info.memory_bytes += memory.memoryHeaps[heap].size;

    info.missing = version < VK_API_VERSION_1_3 ? "Vulkan 1.3 (it has " + info.api_version + ")" : find_missing(device);
    info.usable = info.missing.empty();
    return info;
}

DeviceFeatures features_to_enable(VkPhysicalDevice device, bool with_atomic_float) {
    DeviceFeatures have, enabled;
    vkGetPhysicalDeviceFeatures2(device, have.link(with_atomic_float));
    take(have.core.features, required_core, enabled.core.features);
    take(have.core.features, optional_core, enabled.core.features);
    take(have.vulkan11, required_vulkan11, enabled.vulkan11);
    take(have.vulkan11, optional_vulkan11, enabled.vulkan11);
    take(have.vulkan12, required_vulkan12, enabled.vulkan12);
    take(have.vulkan12, optional_vulkan12, enabled.vulkan12);
    take(have.vulkan13, required_vulkan13, enabled.vulkan13);
    take(have.vulkan13, optional_vulkan13, enabled.vulkan13);
    enabled.atomic_float.shaderBufferFloat32Atomics = have.atomic_float.shaderBufferFloat32Atomics;
    enabled.atomic_float.shaderBufferFloat32AtomicAdd = have.atomic_float.shaderBufferFloat32AtomicAdd;
    enabled.atomic_float.shaderSharedFloat32AtomicAdd = have.atomic_float.shaderSharedFloat32AtomicAdd;
    enabled.atomic_float.shaderSharedFloat32Atomics = have.atomic_float.shaderSharedFloat32Atomics;
    return enabled;
}

}  // namespace heliodon::gpu
