#include "gpu/uploads.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "gpu/format.h"

namespace heliodon::gpu {
namespace {

constexpr VkDeviceSize block_bytes = VkDeviceSize{16} << 20;
// Enough for every texel block and for copies of 4-byte words.
constexpr VkDeviceSize alignment = 16;

constexpr Access everything_before{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                   VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT,
                                   VK_IMAGE_LAYOUT_UNDEFINED};
constexpr Access copied{VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                        VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL};
constexpr Access readable{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT,
                          VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};

}  // namespace

Result<void> Uploads::begin() {
    if (commands_) return {};
    auto commands = device_.begin_commands("uploads");
    if (!commands) return tl::unexpected(commands.error());
    commands_.emplace(std::move(*commands));
    commands_->begin_label("uploads");
    commands_->memory_barrier(everything_before, copied);
    return {};
}

Result<void> Uploads::flush() {
    if (!commands_) return {};
    commands_->memory_barrier(copied, everything_before);
    commands_->end_label();
    Commands commands = std::move(*commands_);
    commands_.reset();
    written_.clear();
    auto value = device_.submit_now(std::move(commands), {});
    if (!value) return tl::unexpected(value.error());
    blocks_[block_].value = *value;
    block_ = (block_ + 1) % blocks_.size();
    // The next block may still be read by an earlier batch.
    if (auto waited = device_.wait(blocks_[block_].value); !waited) return waited;
    blocks_[block_].used = 0;
    return {};
}

Result<VkDeviceSize> Uploads::reserve(VkDeviceSize bytes) {
    const VkDeviceSize aligned = (blocks_[block_].used + alignment - 1) / alignment * alignment;
    if (aligned + bytes > block_bytes) {
        if (auto flushed = flush(); !flushed) return tl::unexpected(flushed.error());
        return reserve(bytes);
    }
    Block& block = blocks_[block_];
    if (!block.buffer) {
        auto buffer = Buffer::create(device_, {"upload staging", block_bytes, 0, BufferMemory::upload});
        if (!buffer) return tl::unexpected(buffer.error());
        block.buffer = std::move(*buffer);
    }
    if (auto begun = begin(); !begun) return tl::unexpected(begun.error());
    block.used = aligned + bytes;
    total_bytes_ += bytes;
    return aligned;
}

Result<void> Uploads::add(const Buffer& buffer, std::span<const std::byte> bytes, VkDeviceSize offset) {
    if (offset + bytes.size() > buffer.size())
        return fail(fmt::format("buffer '{}'", buffer.name()),
                    fmt::format("expected at most {} bytes to upload at {}, found {}",
                                buffer.size() - std::min(offset, buffer.size()), offset, bytes.size()));
    while (!bytes.empty()) {
        const std::size_t size = std::min<std::size_t>(bytes.size(), block_bytes);
        auto staged = reserve(size);
        if (!staged) return tl::unexpected(staged.error());
        const Buffer& staging = blocks_[block_].buffer;
        std::memcpy(staging.mapped().data() + *staged, bytes.data(), size);
        const bool again = std::ranges::any_of(written_, [&](const Written& w) {
            return w.buffer == buffer.handle() && offset < w.end && w.begin < offset + size;
        });
        if (again) {
            commands_->memory_barrier(copied, copied);
            written_.clear();
        }
        commands_->copy(staging, buffer, size, *staged, offset);
        written_.push_back({buffer.handle(), offset, offset + size});
        bytes = bytes.subspan(size);
        offset += size;
    }
    buffer.set_state({readable.stages, readable.access, VK_IMAGE_LAYOUT_UNDEFINED});
    return {};
}

Result<void> Uploads::add(const Image& image, std::span<const std::byte> bytes, std::uint32_t mip,
                          std::uint32_t layer) {
    const std::string where = fmt::format("image '{}', mip {}, layer {}", image.name(), mip, layer);
    if (mip >= image.mips() || layer >= image.layers()) return fail(where, "the image has no such part");
    const VkDeviceSize expected = level_bytes(image.format(), image.description().extent, mip);
    if (expected == 0) return fail(where, "uploads do not know this format");
    if (bytes.size() != expected)
        return fail(where, fmt::format("expected {} bytes to upload, found {}", expected, bytes.size()));

    const FormatInfo format = format_info(image.format());
    const VkExtent3D extent = image.extent(mip);
    const std::uint32_t block_rows = (extent.height + format.block_extent - 1) / format.block_extent;
    const VkDeviceSize row_bytes = expected / extent.depth / block_rows;
    const auto rows_at_once = static_cast<std::uint32_t>(std::max<VkDeviceSize>(1, block_bytes / row_bytes));
    const ImageView part{&image, mip, 1, layer, 1};
    bool first = true;
    for (std::uint32_t slice = 0; slice < extent.depth; ++slice) {
        for (std::uint32_t row = 0; row < block_rows;) {
            const std::uint32_t rows = std::min(rows_at_once, block_rows - row);
            const VkDeviceSize size = rows * row_bytes;
            auto staged = reserve(size);
            if (!staged) return tl::unexpected(staged.error());
            const Buffer& staging = blocks_[block_].buffer;
            std::memcpy(staging.mapped().data() + *staged, bytes.data(), size);
            if (first) commands_->barrier(part, {everything_before.stages, everything_before.access}, copied);
            first = false;
            VkBufferImageCopy region{};
            region.bufferOffset = *staged;
            region.imageSubresource = {format.aspect, mip, layer, 1};
            region.imageOffset = {0, static_cast<std::int32_t>(row * format.block_extent),
                                  static_cast<std::int32_t>(slice)};
            region.imageExtent = {extent.width,
                                  std::min(rows * format.block_extent, extent.height - row * format.block_extent), 1};
            vkCmdCopyBufferToImage(commands_->handle(), staging.handle(), image.handle(),
                                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
            bytes = bytes.subspan(size);
            row += rows;
        }
    }
    commands_->barrier(part, copied, readable);
    image.set_state(readable);
    return {};
}

}  // namespace heliodon::gpu
