#include <fmt/format.h>

#include <cstring>

#include "gpu/commands.h"
#include "gpu/device.h"
#include "gpu/format.h"

namespace heliodon::gpu {
namespace {

constexpr Access any_write{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT};
constexpr Access copy_source{VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT,
                             VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};
constexpr Access copy_target{VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT};
constexpr Access host{VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT};

std::vector<std::byte> content(const Buffer& staging) {
    const auto mapped = staging.mapped();
    return {mapped.begin(), mapped.end()};
}

}  // namespace

Result<std::vector<std::byte>> Device::read_back(const Buffer& buffer, VkDeviceSize offset, VkDeviceSize size) {
    if (offset > buffer.size() || (size != VK_WHOLE_SIZE && size > buffer.size() - offset))
        return fail(fmt::format("buffer '{}'", buffer.name()),
                    fmt::format("cannot read {} bytes at {} of {}", size, offset, buffer.size()));
    if (size == VK_WHOLE_SIZE) size = buffer.size() - offset;
    auto staging = Buffer::create(*this, {"read-back of " + buffer.name(), size, 0, BufferMemory::read_back});
    if (!staging) return tl::unexpected(staging.error());
    auto done = run("read back " + buffer.name(), [&](Commands& commands) {
        commands.memory_barrier(any_write, copy_source);
        commands.copy(buffer, *staging, size, offset, 0);
        commands.memory_barrier(copy_target, host);
    });
    if (!done) return tl::unexpected(done.error());
    return content(*staging);
}

Result<std::vector<std::byte>> Device::read_back(const Image& image, std::uint32_t mip, std::uint32_t layer) {
    const std::string where = fmt::format("image '{}', mip {}, layer {}", image.name(), mip, layer);
    if (mip >= image.mips() || layer >= image.layers()) return fail(where, "the image has no such part");
    const VkDeviceSize size = level_bytes(image.format(), image.description().extent, mip);
    if (size == 0) return fail(where, "read-back does not know this format");
    if (image.description().samples != VK_SAMPLE_COUNT_1_BIT)
        return fail(where, "a multisampled image cannot be read back");
    // Pending uploads set the state when they were asked for, so it is known whether anything was written.
    const Access state = image.state();
    if (state.layout == VK_IMAGE_LAYOUT_UNDEFINED) return fail(where, "it was never written");
    auto staging = Buffer::create(*this, {"read-back of " + image.name(), size, 0, BufferMemory::read_back});
    if (!staging) return tl::unexpected(staging.error());
    auto done = run("read back " + image.name(), [&](Commands& commands) {
        const ImageView part{&image, mip, 1, layer, 1};
        Access before = any_write;
        before.layout = state.layout;
        Access after{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT,
                     state.layout};
        commands.barrier(part, before, copy_source);
        commands.copy(part, *staging);
        commands.barrier(part, copy_source, after);
        commands.memory_barrier(copy_target, host);
    });
    if (!done) return tl::unexpected(done.error());
    return content(*staging);
}

}  // namespace heliodon::gpu
