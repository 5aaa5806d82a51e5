#include "gpu/commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "gpu/command_recording.h"
#include "gpu/device.h"
#include "gpu/format.h"

namespace heliodon::gpu {
namespace {

VkImageSubresourceLayers layers_of(const ImageView& view) {
    const Image& image = *view.image;
    const std::uint32_t layers = view.layers == all_remaining ? image.layers() - view.base_layer : view.layers;
    return {format_info(image.format()).aspect, view.base_mip, view.base_layer, layers};
}

VkImageSubresourceRange range_of(const ImageView& view) {
    return {format_info(view.image->format()).aspect, view.base_mip, view.mips, view.base_layer, view.layers};
}

VkOffset3D far_corner(VkExtent3D extent) {
    return {static_cast<std::int32_t>(extent.width), static_cast<std::int32_t>(extent.height),
            static_cast<std::int32_t>(extent.depth)};
}

VkMemoryBarrier2 memory_barrier_of(const Access& before, const Access& after) {
    VkMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
    barrier.srcStageMask = before.stages;
    barrier.srcAccessMask = before.access;
    barrier.dstStageMask = after.stages;
    barrier.dstAccessMask = after.access;
    return barrier;
}

}  // namespace

Commands::Commands(std::unique_ptr<CommandRecording> recording) : recording_(std::move(recording)) {}
Commands::Commands(Commands&&) noexcept = default;

Commands& Commands::operator=(Commands&& other) noexcept {
    std::swap(recording_, other.recording_);
    return *this;
}

Commands::~Commands() {
    if (!recording_) return;
    Device& device = recording_->device;
    --device.open_recordings_;
    device.recordings_.push_back(std::move(recording_));
}

VkCommandBuffer Commands::handle() const {
    return recording_->buffer;
}
Device& Commands::device() const {
    return recording_->device;
}
const std::optional<Error>& Commands::error() const {
    return recording_->error;
}

void Commands::fail(std::string where, std::string message) {
    if (recording_->error) return;
    if (!recording_->labels.empty()) where = "pass '" + recording_->labels.back() + "', " + where;
    recording_->error = Error{std::move(where), std::move(message)};
}

void Commands::fill(const Buffer& buffer, std::uint32_t value, VkDeviceSize offset, VkDeviceSize size) {
    if (size != VK_WHOLE_SIZE && (offset % 4 != 0 || size % 4 != 0 || offset + size > buffer.size()))
        return fail(fmt::format("buffer '{}'", buffer.name()),
                    fmt::format("cannot fill {} bytes at {} of {}: expected whole 32-bit words inside it", size, offset,
                                buffer.size()));
    vkCmdFillBuffer(handle(), buffer.handle(), offset, size, value);
}

void Commands::copy(const Buffer& from, const Buffer& to, VkDeviceSize bytes, VkDeviceSize from_offset,
                    VkDeviceSize to_offset) {
    if (bytes == 0) return;
    if (from_offset + bytes > from.size() || to_offset + bytes > to.size())
        return fail(fmt::format("copy of buffer '{}' to '{}'", from.name(), to.name()),
                    fmt::format("{} bytes from {} to {} do not fit in {} and {}", bytes, from_offset, to_offset,
                                from.size(), to.size()));
    const VkBufferCopy region{from_offset, to_offset, bytes};
    vkCmdCopyBuffer(handle(), from.handle(), to.handle(), 1, &region);
}

void Commands::copy(const ImageView& from, const ImageView& to) {
    VkImageCopy region{};
    region.srcSubresource = layers_of(from);
    region.dstSubresource = layers_of(to);
    region.extent = from.image->extent(from.base_mip);
    const VkExtent3D target = to.image->extent(to.base_mip);
    if (region.extent.width != target.width || region.extent.height != target.height ||
        region.extent.depth != target.depth)
        return fail(fmt::format("copy of image '{}' to '{}'", from.image->name(), to.image->name()),
                    "their sizes differ");
    vkCmdCopyImage(handle(), from.image->handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to.image->handle(),
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
}

void Commands::copy(const ImageView& from, const Buffer& to, VkDeviceSize to_offset) {
    VkBufferImageCopy region{};
    region.bufferOffset = to_offset;
    region.imageSubresource = layers_of(from);
    region.imageExtent = from.image->extent(from.base_mip);
    const VkDeviceSize bytes = level_bytes(from.image->format(), from.image->description().extent, from.base_mip) *
                               region.imageSubresource.layerCount;
    if (to_offset + bytes > to.size())
        return fail(fmt::format("copy of image '{}' to buffer '{}'", from.image->name(), to.name()),
                    fmt::format("{} bytes at {} do not fit in {}", bytes, to_offset, to.size()));
    vkCmdCopyImageToBuffer(handle(), from.image->handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to.handle(), 1,
                           &region);
}

void Commands::blit(const ImageView& from, const ImageView& to, VkFilter filter) {
    VkImageBlit region{};
    region.srcSubresource = layers_of(from);
    region.dstSubresource = layers_of(to);
    region.srcOffsets[1] = far_corner(from.image->extent(from.base_mip));
    region.dstOffsets[1] = far_corner(to.image->extent(to.base_mip));
    vkCmdBlitImage(handle(), from.image->handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to.image->handle(),
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region, filter);
}

void Commands::clear(const ImageView& view, VkClearColorValue value) {
    const VkImageSubresourceRange range = range_of(view);
    vkCmdClearColorImage(handle(), view.image->handle(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &value, 1, &range);
}

void Commands::clear_depth(const ImageView& view, float value) {
    const VkImageSubresourceRange range = range_of(view);
    const VkClearDepthStencilValue clear_value{value, 0};
    vkCmdClearDepthStencilImage(handle(), view.image->handle(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &clear_value, 1,
                                &range);
}

void Commands::barrier(const ImageView& view, const Access& before, const Access& after) {
    VkImageMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
    barrier.srcStageMask = before.stages;
    barrier.srcAccessMask = before.access;
    barrier.dstStageMask = after.stages;
    barrier.dstAccessMask = after.access;
    barrier.oldLayout = before.layout;
    barrier.newLayout = after.layout;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = view.image->handle();
    barrier.subresourceRange = range_of(view);
    barriers({&barrier, 1}, {});
}

void Commands::memory_barrier(const Access& before, const Access& after) {
    const VkMemoryBarrier2 barrier = memory_barrier_of(before, after);
    barriers({}, {&barrier, 1});
}

void Commands::compute_barrier() {
    memory_barrier(
        {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT},
        {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_READ_BIT | VK_ACCESS_2_SHADER_WRITE_BIT});
}

void Commands::barriers(std::span<const VkImageMemoryBarrier2> images, std::span<const VkMemoryBarrier2> memory) {
    VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    info.imageMemoryBarrierCount = static_cast<std::uint32_t>(images.size());
    info.pImageMemoryBarriers = images.data();
    info.memoryBarrierCount = static_cast<std::uint32_t>(memory.size());
    info.pMemoryBarriers = memory.data();
    vkCmdPipelineBarrier2(handle(), &info);
}

void Commands::transition(const Image& image, const Access& after) {
    barrier({&image}, image.state(), after);
    image.set_state(after);
}

void Commands::begin_label(const std::string& name) {
    recording_->labels.push_back(name);
    if (!device().functions().begin_label) return;
    VkDebugUtilsLabelEXT label{VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT};
    label.pLabelName = name.c_str();
    device().functions().begin_label(handle(), &label);
}

void Commands::end_label() {
    if (recording_->labels.empty()) return;
    recording_->labels.pop_back();
    if (device().functions().end_label) device().functions().end_label(handle());
}

}  // namespace heliodon::gpu
