#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gpu/vulkan.h"

namespace heliodon::gpu {

class Commands;
class Device;

struct ScopeTime {
    std::string name;
    double milliseconds = 0;
};
/// GPU times of one frame, in the order the scopes began.
struct FrameTimes {
    std::uint64_t frame = 0;
    std::vector<ScopeTime> scopes;
    double total_milliseconds = 0;  ///< first timestamp to last
};

/// GPU time of named scopes. Results come some frames later without waiting, or now with.
class Timestamps {
public:
    /// At most `scopes` a frame; further ones are not timed.
    [[nodiscard]] static Result<Timestamps> create(Device& device, std::uint32_t scopes = 256);
    Timestamps() = default;
    ~Timestamps();
    Timestamps(Timestamps&& other) noexcept;
    Timestamps& operator=(Timestamps&& other) noexcept;

    /// What is timed of a frame: each scope, which keeps work that could overlap a little apart, or its beginning and end.
    enum class Detail : std::uint8_t { scopes, whole };
    void begin_frame(Detail detail = Detail::scopes);
    [[nodiscard]] std::uint32_t begin(Commands& commands, const std::string& name);
    void end(Commands& commands, std::uint32_t scope);
    /// After the last scope of a frame of which the whole is timed.
    void end_frame(Commands& commands);

    /// The newest frame whose times are known; frame 0 with no scopes before there is one. Never waits.
    [[nodiscard]] const FrameTimes& latest();
    /// The times of the frame recorded last; its commands must have been submitted.
    [[nodiscard]] Result<FrameTimes> wait();

private:
    struct Frame {
        VkQueryPool pool = VK_NULL_HANDLE;
        std::uint64_t number = 0;
        std::vector<std::string> names;
        bool pending = false;
        Detail detail = Detail::scopes;
    };
    [[nodiscard]] bool read(Frame& frame, VkQueryResultFlags flags);
    void reset();

    Device* device_ = nullptr;
    std::uint32_t capacity_ = 0;
    std::uint64_t number_ = 0;
    std::vector<Frame> frames_;
    FrameTimes latest_;
};

}  // namespace heliodon::gpu
