#include "app/editor/window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

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
    if (!glfwInit()) return fail("window", "no display: " + glfw_message());
    Window window;
    window.session_ = std::make_unique<Session>();
    if (!glfwVulkanSupported()) return fail("window", "this desktop offers no Vulkan surfaces: " + glfw_message());
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    window.handle_.reset(glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr));
    if (!window.handle_) return fail("window", glfw_message());
    window.events_ = std::make_unique<Events>();
    glfwSetWindowUserPointer(window.handle(), window.events_.get());
    glfwSetScrollCallback(window.handle(), [](GLFWwindow* handle, double, double steps) {
        static_cast<Events*>(glfwGetWindowUserPointer(handle))->scroll += static_cast<float>(steps);
    });
    glfwSetKeyCallback(window.handle(), [](GLFWwindow* handle, int key, int, int action, int) {
        if (action != GLFW_PRESS) return;
        auto& events = *static_cast<Events*>(glfwGetWindowUserPointer(handle));
        if (key == GLFW_KEY_TAB) events.toggle_panels = true;
        if (key == GLFW_KEY_F5) events.reload_shaders = true;
        if (key == GLFW_KEY_ESCAPE) glfwSetWindowShouldClose(handle, GLFW_TRUE);
    });
    return window;
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
void Window::close() { glfwSetWindowShouldClose(handle(), GLFW_TRUE); }

VkExtent2D Window::extent() const {
    int width = 0, height = 0;
    glfwGetFramebufferSize(handle(), &width, &height);
    return {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)};
}

void Window::set_title(const std::string& title) { glfwSetWindowTitle(handle(), title.c_str()); }

Input Window::poll(bool wait) {
    wait ? glfwWaitEvents() : glfwPollEvents();
    Input input;
    double x = 0, y = 0;
    glfwGetCursorPos(handle(), &x, &y);
    const glm::vec2 pointer(static_cast<float>(x), static_cast<float>(y));
    input.drag = pointer - pointer_;
    pointer_ = pointer;
    const auto held = [&](int button) { return glfwGetMouseButton(handle(), button) == GLFW_PRESS; };
    input.buttons = {held(GLFW_MOUSE_BUTTON_LEFT), held(GLFW_MOUSE_BUTTON_RIGHT), held(GLFW_MOUSE_BUTTON_MIDDLE)};
    const auto key = [&](int name) { return glfwGetKey(handle(), name) == GLFW_PRESS ? 1.0f : 0.0f; };
    input.keys = {key(GLFW_KEY_D) - key(GLFW_KEY_A), key(GLFW_KEY_E) - key(GLFW_KEY_Q), key(GLFW_KEY_W) - key(GLFW_KEY_S)};
    input.scroll = events_->scroll;
    input.toggle_panels = events_->toggle_panels;
    input.reload_shaders = events_->reload_shaders;
    *events_ = {};
    return input;
}

}  // namespace heliodon::editor
