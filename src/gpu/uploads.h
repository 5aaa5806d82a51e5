#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "gpu/commands.h"
#include "gpu/device.h"

namespace heliodon::gpu {

/// Copies through a ring of staging buffers into one command buffer, which Device submits before any other work.
class Uploads {
public:
    explicit Uploads(Device& device) : device_(device) {}

    [[nodiscard]] Result<void> add(const Buffer& buffer, std::span<const std::byte> bytes, VkDeviceSize offset);
    [[nodiscard]] Result<void> add(const Image& image, std::span<const std::byte> bytes, std::uint32_t mip,
                                   std::uint32_t layer);
    /// Submits what is pending, if anything is.
    [[nodiscard]] Result<void> flush();
    [[nodiscard]] bool pending() const { return commands_.has_value(); }
    [[nodiscard]] std::uint64_t total_bytes() const { return total_bytes_; }

private:
    struct Block {
        Buffer buffer;
        VkDeviceSize used = 0;
        TimelineValue value = 0;  // of the submission that last read it
    };
    struct Written {
        VkBuffer buffer;
        VkDeviceSize begin, end;
    };
    /// Room for `bytes` in the current block, after a flush if needed.
    [[nodiscard]] Result<VkDeviceSize> reserve(VkDeviceSize bytes);
    [[nodiscard]] Result<void> begin();

    Device& device_;
    std::array<Block, 3> blocks_;
    std::size_t block_ = 0;
    std::optional<Commands> commands_;
    std::vector<Written> written_;  // in this batch
    std::uint64_t total_bytes_ = 0;
};

}  // namespace heliodon::gpu
