#include "app/editor/window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <cstdlib>

namespace heliodon::editor {
namespace {

std::string glfw_message() {
    const char* description = nullptr;
    glfwGetError(&description);
    return description ? description : "unknown reason";
}

}  // namespace

// GLFW declares this only when vulkan.h precedes it in its own way; the signature is documented.
extern "C" VkResult glfwCreateWindowSurface(VkInstance, GLFWwindow*, const VkAllocationCallbacks*, VkSurfaceKHR*);

Window::Session::~Session() { glfwTerminate(); }
void Window::Destroy::operator()(GLFWwindow* window) const { glfwDestroyWindow(window); }

Result<Window> Window::create(const std::string& title, int width, int height) {
#ifdef GLFW_PLATFORM_X11  // GLFW 3.4 also knows Wayland, whose library complains on standard error of its absence
    if (!std::getenv("WAYLAND_DISPLAY")) glfwInitHint(GLFW_PLATFORM, GLFW_PLATFORM_X11);
#endif
    if (!glfwInit()) return fail("window", "no display: " + glfw_message());
    Window window;
    window.session_ = std::make_unique<Session>();
    if (!glfwVulkanSupported()) return fail("window", "this desktop offers no Vulkan surfaces: " + glfw_message());
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    window.handle_.reset(glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr));
    if (!window.handle_) return fail("window", glfw_message());
    window.events_ = std::make_unique<Events>();
    listen(window.handle(), *window.events_);
    return window;
}

void Window::listen(GLFWwindow* window, Events& events) {
    static constexpr auto of = [](GLFWwindow* handle) -> Events& { return *static_cast<Events*>(glfwGetWindowUserPointer(handle)); };
    glfwSetWindowUserPointer(window, &events);
    glfwSetCursorPosCallback(window, [](GLFWwindow* handle, double x, double y) {
        Events& state = of(handle);
        const glm::vec2 pointer(static_cast<float>(x), static_cast<float>(y));
        for (std::size_t button = 0; button < state.held.size(); ++button)
            if (state.held[button]) state.input.drags[button] += pointer - state.pointer;
        state.pointer = pointer;
    });
    glfwSetMouseButtonCallback(window, [](GLFWwindow* handle, int button, int action, int) {
        Events& state = of(handle);
        if (button < static_cast<int>(state.held.size())) state.held[static_cast<std::size_t>(button)] = action == GLFW_PRESS;
    });
    glfwSetScrollCallback(window, [](GLFWwindow* handle, double, double steps) {
        of(handle).input.scroll += static_cast<float>(steps);
    });
    glfwSetKeyCallback(window, [](GLFWwindow* handle, int key, int, int action, int) {
        if (action != GLFW_PRESS) return;
        if (key == GLFW_KEY_TAB) of(handle).input.toggle_panels ^= true;
        if (key == GLFW_KEY_F5) of(handle).input.reload_shaders = true;
        if (key == GLFW_KEY_ESCAPE) glfwSetWindowShouldClose(handle, GLFW_TRUE);
    });
}

std::vector<std::string> Window::instance_extensions() const {
    std::uint32_t count = 0;
    const char** names = glfwGetRequiredInstanceExtensions(&count);
    return {names, names + count};
}

Result<VkSurfaceKHR> Window::create_surface(VkInstance instance) const {
    VkSurfaceKHR surface = VK_NULL_HANDLE;
    const VkResult result = glfwCreateWindowSurface(instance, handle(), nullptr, &surface);
    if (result != VK_SUCCESS) return gpu::vulkan_failure("window", "creating a surface", result);
    return surface;
}

bool Window::should_close() const { return glfwWindowShouldClose(handle()); }

VkExtent2D Window::extent() const {
    int width = 0, height = 0;
    glfwGetFramebufferSize(handle(), &width, &height);
    return {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)};
}


Input Window::poll(bool wait) {
    wait ? glfwWaitEvents() : glfwPollEvents();
    Input input = events_->input;
    events_->input = {};
    const auto key = [&](int name) { return glfwGetKey(handle(), name) == GLFW_PRESS ? 1.0f : 0.0f; };
    input.keys = {key(GLFW_KEY_D) - key(GLFW_KEY_A), key(GLFW_KEY_E) - key(GLFW_KEY_Q), key(GLFW_KEY_W) - key(GLFW_KEY_S)};
    return input;
}

}  // namespace heliodon::editor
