#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "core/math.h"
#include "gpu/vulkan.h"

struct GLFWwindow;

namespace heliodon::editor {

/// What the user did since the last poll.
struct Input {
    /// Pixels, right and down, that the pointer moved with the left, right, middle button held.
    std::array<glm::vec2, 3> drags{};
    float scroll = 0;      ///< steps away from the user
    glm::vec3 keys{0};     ///< right, up, forward: −1, 0 or 1 (D A, E Q, W S)
    bool toggle_panels = false;  ///< Tab was pressed
    bool reload_shaders = false; ///< F5 was pressed
};

/// A window of the desktop with a Vulkan surface. One at a time, on the main thread (GLFW's rule).
class Window {
public:
    /// Error when there is no display or it has no Vulkan surfaces.
    [[nodiscard]] static Result<Window> create(const std::string& title, int width, int height);
    /// The instance extensions that surfaces of this desktop need; the window system must be up (create first).
    [[nodiscard]] std::vector<std::string> instance_extensions() const;
    /// The surface belongs to the caller, who destroys it before the instance.
    [[nodiscard]] Result<VkSurfaceKHR> create_surface(VkInstance instance) const;

    [[nodiscard]] bool should_close() const;
    [[nodiscard]] VkExtent2D extent() const;  ///< of the framebuffer; 0×0 while minimized
    /// Handles pending events; waits for one when `wait` (minimized).
    [[nodiscard]] Input poll(bool wait = false);
    [[nodiscard]] GLFWwindow* handle() const { return handle_.get(); }

private:
    struct Session {
        ~Session();
    };
    struct Destroy {
        void operator()(GLFWwindow* window) const;
    };
    // Collected event by event: a drag that begins and ends between two slow frames still counts.
    struct Events {
        Input input;
        glm::vec2 pointer{0};
        std::array<bool, 3> held{};
    };
    Window() = default;
    static void listen(GLFWwindow* window, Events& events);

    std::unique_ptr<Session> session_;
    std::unique_ptr<Events> events_;  // its address is the callbacks' user pointer
    std::unique_ptr<GLFWwindow, Destroy> handle_;
};

}  // namespace heliodon::editor
