#include "gpu/timestamps.h"

#include <algorithm>
#include <utility>

#include "gpu/commands.h"
#include "gpu/device.h"

namespace heliodon::gpu {

namespace {

/// Mesa's lavapipe writes a timestamp when it next flushes its rasterizer, long after the compute work that
/// followed was done at once; a barrier makes it flush now, so that a pass's time is the pass's own.
void write_timestamp(Commands& commands, VkQueryPool pool, std::uint32_t query) {
    vkCmdWriteTimestamp2(commands.handle(), VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, pool, query);
    if (!commands.device().info().is_cpu) return;
    constexpr Access everything{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT};
    commands.memory_barrier(everything, everything);
}

}  // namespace

Result<Timestamps> Timestamps::create(Device& device, std::uint32_t scopes) {
    Timestamps timestamps;
    timestamps.device_ = &device;
    timestamps.capacity_ = scopes;
    return timestamps;
}

Timestamps::~Timestamps() {
    reset();
}

void Timestamps::reset() {
    for (Frame& frame : frames_)
        device_->retire([device = device_->handle(), pool = frame.pool] { vkDestroyQueryPool(device, pool, nullptr); });
    frames_.clear();
}

Timestamps::Timestamps(Timestamps&& other) noexcept {
    *this = std::move(other);
}

Timestamps& Timestamps::operator=(Timestamps&& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(capacity_, other.capacity_);
    std::swap(number_, other.number_);
    std::swap(frames_, other.frames_);
    std::swap(latest_, other.latest_);
    return *this;
}

void Timestamps::begin_frame(Detail detail) {
    static_cast<void>(latest());  // reads what is complete, which frees its pools
    ++number_;
    // The GPU has caught up and yet there is no result: those commands were never submitted.
    if (device_->completed() == device_->submitted())
        for (Frame& frame : frames_) frame.pending = false;
    auto free = std::ranges::find(frames_, false, &Frame::pending);
    if (free == frames_.end()) {
        VkQueryPoolCreateInfo info{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
        info.queryType = VK_QUERY_TYPE_TIMESTAMP;
        info.queryCount = 2 * capacity_;
        Frame frame;
        if (vkCreateQueryPool(device_->handle(), &info, nullptr, &frame.pool) != VK_SUCCESS) return;
        device_->set_name(VK_OBJECT_TYPE_QUERY_POOL, reinterpret_cast<std::uint64_t>(frame.pool), "timestamps");
        free = frames_.insert(frames_.end(), frame);
    }
    vkResetQueryPool(device_->handle(), free->pool, 0, 2 * capacity_);
    free->number = number_;
    free->names.clear();
    free->pending = true;
    free->detail = detail;
}

std::uint32_t Timestamps::begin(Commands& commands, const std::string& name) {
    const auto frame = std::ranges::find(frames_, number_, &Frame::number);
    if (frame == frames_.end() || frame->names.size() >= capacity_) return ~0u;
    const bool whole = frame->detail == Detail::whole;
    if (whole && !frame->names.empty()) return ~0u;
    const auto scope = static_cast<std::uint32_t>(frame->names.size());
    frame->names.push_back(whole ? "frame" : name);
    write_timestamp(commands, frame->pool, 2 * scope);
    return whole ? ~0u : scope;
}

void Timestamps::end_frame(Commands& commands) {
    const auto frame = std::ranges::find(frames_, number_, &Frame::number);
    if (frame == frames_.end() || frame->detail == Detail::scopes || frame->names.empty()) return;
    write_timestamp(commands, frame->pool, 1);
}

void Timestamps::end(Commands& commands, std::uint32_t scope) {
    const auto frame = std::ranges::find(frames_, number_, &Frame::number);
    if (frame == frames_.end() || scope >= frame->names.size()) return;
    write_timestamp(commands, frame->pool, 2 * scope + 1);
}

bool Timestamps::read(Frame& frame, VkQueryResultFlags flags) {
    const auto count = static_cast<std::uint32_t>(2 * frame.names.size());
    std::vector<std::uint64_t> ticks(count);
    if (count > 0) {
        const VkResult result =
            vkGetQueryPoolResults(device_->handle(), frame.pool, 0, count, count * sizeof(std::uint64_t), ticks.data(),
                                  sizeof(std::uint64_t), VK_QUERY_RESULT_64_BIT | flags);
        if (result != VK_SUCCESS) return false;
    }
    frame.pending = false;
    if (frame.number < latest_.frame) return true;
    // limits.timestampPeriod: nanoseconds a tick.
    const double milliseconds_per_tick = device_->limits().timestampPeriod * 1e-6;
    const auto elapsed = [&](std::uint64_t from, std::uint64_t to) {
        return to > from ? static_cast<double>(to - from) * milliseconds_per_tick : 0.0;
    };
    latest_ = {frame.number, {}, 0.0};
    for (std::size_t scope = 0; scope < frame.names.size(); ++scope)
        latest_.scopes.push_back({frame.names[scope], elapsed(ticks[2 * scope], ticks[2 * scope + 1])});
    if (count > 0) {
        const auto [first, last] = std::ranges::minmax(ticks);
        latest_.total_milliseconds = elapsed(first, last);
    }
    return true;
}

const FrameTimes& Timestamps::latest() {
    for (Frame& frame : frames_)
        if (frame.pending) static_cast<void>(read(frame, 0));
    return latest_;
}

Result<FrameTimes> Timestamps::wait() {
    const auto frame = std::ranges::find(frames_, number_, &Frame::number);
    if (frame == frames_.end()) return fail("timestamps", "no frame was recorded");
    if (!frame->pending) return latest_;
    if (auto waited = device_->wait(device_->submitted()); !waited) return tl::unexpected(waited.error());
    if (!read(*frame, 0))
        return fail("timestamps", "the frame recorded last was not submitted, or a scope was not ended");
    return latest_;
}

}  // namespace heliodon::gpu
