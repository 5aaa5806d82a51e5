#include "gpu/instance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>

#include "gpu/device_features.h"

namespace heliodon::gpu {
namespace {

constexpr const char* validation_layer = "VK_LAYER_KHRONOS_validation";

std::vector<std::string> instance_extensions(const char* layer) {
    std::uint32_t count = 0;
    vkEnumerateInstanceExtensionProperties(layer, &count, nullptr);
    std::vector<VkExtensionProperties> properties(count);
    vkEnumerateInstanceExtensionProperties(layer, &count, properties.data());
    std::vector<std::string> names;
    for (const auto& property : properties) names.emplace_back(property.extensionName);
    return names;
}

bool has_layer(const char* name) {
    std::uint32_t count = 0;
    vkEnumerateInstanceLayerProperties(&count, nullptr);
    std::vector<VkLayerProperties> layers(count);
    vkEnumerateInstanceLayerProperties(&count, layers.data());
    return std::ranges::any_of(layers, [&](const auto& layer) { return std::string_view(layer.layerName) == name; });
}

VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                          const VkDebugUtilsMessengerCallbackDataEXT* data, void* instance) {
    const std::string text = data->pMessage ? data->pMessage : "";
    const std::string name = data->pMessageIdName ? data->pMessageIdName : "";
    // Older layers write the message's name into its text, newer ones only beside it.
    const bool named = text.find(name) != std::string::npos;
    static_cast<Instance*>(instance)->add_validation_message(named ? text : name + ": " + text);
    return VK_FALSE;
}

/// Core entry points go through the loader, so they serve every instance and device: loaded once.
void load_core_functions(VkInstance instance) {
    static std::once_flag once;
    std::call_once(once, [&] { volkLoadInstance(instance); });
}

VkResult initialize_loader() {
    static const VkResult result = volkInitialize();
    return result;
}

int rank(const DeviceInfo& device) {
    switch (device.type) {
        case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
            return 0;
        case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
            return 1;
        case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
            return 2;
        case VK_PHYSICAL_DEVICE_TYPE_CPU:
            return 3;
        default:
            return 4;
    }
}

std::string lower_case(std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

std::string list_of(const std::vector<DeviceInfo>& devices) {
    std::string text;
    for (const auto& device : devices)
        text += fmt::format("{}{} {}", text.empty() ? "" : ", ", device.number, device.name);
    return text.empty() ? "there is none" : "there are: " + text;
}

}  // namespace

Result<std::shared_ptr<Instance>> Instance::create(const InstanceSettings& settings) {
    if (initialize_loader() != VK_SUCCESS) return fail("", "no Vulkan loader (libvulkan.so.1) is installed");
    if (volkGetInstanceVersion() < VK_API_VERSION_1_3) return fail("", "the Vulkan loader is older than 1.3");

    std::vector<std::string> available = instance_extensions(nullptr);
    std::vector<const char*> layers;
    if (settings.validation) {
        if (!has_layer(validation_layer))
            return fail("", fmt::format("the layer {} is not installed", validation_layer));
        layers.push_back(validation_layer);
        for (auto& name : instance_extensions(validation_layer)) available.push_back(std::move(name));
    }
    std::vector<const char*> extensions;
    for (const auto& name : settings.extensions) {
        if (!contains(available, name.c_str()))
            return fail("", fmt::format("the instance extension {} is missing", name));
        extensions.push_back(name.c_str());
    }
    const bool debug_names = contains(available, VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    if (debug_names) extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    const bool features_extension =
        settings.validation && contains(available, VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME);
    if (features_extension) extensions.push_back(VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME);

    std::shared_ptr<Instance> instance(new Instance());
    instance->debug_names_ = debug_names;

    const VkValidationFeatureEnableEXT enables[] = {VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
    VkValidationFeaturesEXT features{VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT};
    features.enabledValidationFeatureCount = 1;
    features.pEnabledValidationFeatures = enables;
    VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
    application.pApplicationName = "Heliodon";
    application.pEngineName = "Heliodon";
    application.apiVersion = VK_API_VERSION_1_3;
    VkInstanceCreateInfo create{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
    create.pNext = features_extension ? &features : nullptr;
    create.pApplicationInfo = &application;
    create.enabledLayerCount = static_cast<std::uint32_t>(layers.size());
    create.ppEnabledLayerNames = layers.data();
    create.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
    create.ppEnabledExtensionNames = extensions.data();
    const VkResult created = vkCreateInstance(&create, nullptr, &instance->handle_);
    if (created == VK_ERROR_INCOMPATIBLE_DRIVER)
        return fail("", "no Vulkan driver is installed (Mesa's lavapipe runs on any CPU)");
    if (created != VK_SUCCESS) return vulkan_failure("", "cannot create a Vulkan instance", created);
    load_core_functions(instance->handle_);

    if (settings.validation && debug_names) {
        VkDebugUtilsMessengerCreateInfoEXT messenger{VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
        messenger.messageSeverity =
            VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
        messenger.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
        messenger.pfnUserCallback = on_message;
        messenger.pUserData = instance.get();
        const auto create_messenger = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
            vkGetInstanceProcAddr(instance->handle_, "vkCreateDebugUtilsMessengerEXT"));
        if (const VkResult result = create_messenger(instance->handle_, &messenger, nullptr, &instance->messenger_);
            result != VK_SUCCESS)
            return vulkan_failure("", "cannot listen to the validation layer", result);
    }
    return instance;
}

Instance::~Instance() {
    if (messenger_) {
        const auto destroy = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
            vkGetInstanceProcAddr(handle_, "vkDestroyDebugUtilsMessengerEXT"));
        destroy(handle_, messenger_, nullptr);
    }
    if (handle_) vkDestroyInstance(handle_, nullptr);
}

Result<VkPhysicalDevice> Instance::physical_device(int number) const {
    std::uint32_t count = 0;
    vkEnumeratePhysicalDevices(handle_, &count, nullptr);
    std::vector<VkPhysicalDevice> devices(count);
    vkEnumeratePhysicalDevices(handle_, &count, devices.data());
    if (number < 0 || static_cast<std::uint32_t>(number) >= count)
        return fail("", fmt::format("there is no Vulkan device {} (there are {})", number, count));
    return devices[number];
}

std::vector<DeviceInfo> Instance::devices() const {
    std::uint32_t count = 0;
    vkEnumeratePhysicalDevices(handle_, &count, nullptr);
    std::vector<DeviceInfo> infos;
    for (std::uint32_t number = 0; number < count; ++number)
        if (const auto device = physical_device(static_cast<int>(number)))
            infos.push_back(describe(*device, static_cast<int>(number)));
    return infos;
}

Result<DeviceInfo> Instance::choose(const std::string& choice) const {
    const std::vector<DeviceInfo> all = devices();
    if (choice.empty()) {
        const DeviceInfo* best = nullptr;
        for (const auto& device : all)
            if (device.usable && (!best || rank(device) < rank(*best))) best = &device;
        if (best) return *best;
        if (!all.empty())
            return fail("", fmt::format("no usable Vulkan device: {} lacks {}", all[0].name, all[0].missing));
        return fail("", "no Vulkan device: is a driver installed?");
    }
    int number = -1;
    const auto parsed = std::from_chars(choice.data(), choice.data() + choice.size(), number);
    const bool is_number = parsed.ec == std::errc() && parsed.ptr == choice.data() + choice.size() && number >= 0 &&
                           number < static_cast<int>(all.size());
    for (const auto& device : all) {
        const bool matches =
            is_number ? device.number == number : lower_case(device.name).find(lower_case(choice)) != std::string::npos;
        if (!matches) continue;
        if (!device.usable) return fail("", fmt::format("the Vulkan device {} lacks {}", device.name, device.missing));
        return device;
    }
    return fail("", fmt::format("no Vulkan device '{}'; {}", choice, list_of(all)));
}

std::vector<std::string> Instance::validation_messages() const {
    const std::lock_guard lock(messages_mutex_);
    return messages_;
}

void Instance::add_validation_message(std::string message) {
    const std::lock_guard lock(messages_mutex_);
    messages_.push_back(std::move(message));
}

Result<std::vector<DeviceInfo>> list_devices() {
    auto instance = Instance::create();
    if (!instance) return tl::unexpected(instance.error());
    return (*instance)->devices();
}

}  // namespace heliodon::gpu
