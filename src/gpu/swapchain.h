#pragma once

#include <optional>
#include <vector>

#include "gpu/image.h"
#include "gpu/vulkan.h"

namespace heliodon::gpu {

class Device;

/// The images of a window. Device must have been created with `swapchain`, and the surface by the window
/// system from the device's instance; the surface stays the caller's and must outlive this.
class Swapchain {
public:
    /// One of these is being drawn to and will be shown.
    struct Frame {
        const Image* image = nullptr;           ///< in UNDEFINED layout; leave it in PRESENT_SRC_KHR
        VkSemaphore acquired = VK_NULL_HANDLE;  ///< the submission waits for it …
        VkSemaphore finished = VK_NULL_HANDLE;  ///< … and signals this
        std::uint32_t index = 0;
    };

    /// `extent` is used where the surface has no size of its own. 8-bit sRGB-encoded values are written by shaders
    /// (UNORM formats are chosen); vsync: FIFO, else mailbox or immediate where offered.
    [[nodiscard]] static Result<Swapchain> create(Device& device, VkSurfaceKHR surface, VkExtent2D extent,
                                                  bool vsync = true);
    Swapchain() = default;
    ~Swapchain();
    Swapchain(Swapchain&& other) noexcept;
    Swapchain& operator=(Swapchain&& other) noexcept;

    /// The next image; empty when the window is minimized or was resized: then call resize().
    [[nodiscard]] Result<std::optional<Frame>> acquire();
    /// After the submission that waits for `frame.acquired` and signals `frame.finished`, before any other one. False:
    /// the window was resized, call resize().
    [[nodiscard]] Result<bool> present(const Frame& frame);
    [[nodiscard]] Result<void> resize(VkExtent2D extent);
    [[nodiscard]] VkExtent2D extent() const { return extent_; }
    [[nodiscard]] VkFormat format() const { return format_; }

private:
    [[nodiscard]] Result<void> build(VkExtent2D extent);
    void reset();

    Device* device_ = nullptr;
    VkSurfaceKHR surface_ = VK_NULL_HANDLE;
    VkSwapchainKHR handle_ = VK_NULL_HANDLE;
    VkExtent2D extent_{};
    VkFormat format_ = VK_FORMAT_UNDEFINED;
    bool vsync_ = true;
    std::vector<Image> images_;
    std::vector<VkSemaphore> acquired_, finished_;
    std::vector<std::uint64_t> uses_;  // by `acquired_`: the submission that waits for it
    std::size_t next_ = 0;
};

}  // namespace heliodon::gpu
