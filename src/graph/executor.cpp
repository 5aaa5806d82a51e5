#include "graph/executor.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "gpu/format.h"

namespace heliodon::graph {
namespace {

constexpr gpu::Access everything{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                 VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT, VK_IMAGE_LAYOUT_UNDEFINED};
constexpr gpu::Access cleared{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                              VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL};

bool same(const gpu::ImageDescription& a, const gpu::ImageDescription& b) {
    return a.format == b.format && a.extent.width == b.extent.width && a.extent.height == b.extent.height &&
           a.extent.depth == b.extent.depth && a.mips == b.mips && a.layers == b.layers && a.shape == b.shape &&
           a.usage == b.usage && a.samples == b.samples;
}

bool same(const gpu::BufferDescription& a, const gpu::BufferDescription& b) {
    return a.size == b.size && a.usage == b.usage && a.memory == b.memory;
}

/// Whether what was read last leaves nothing to wait for.
bool needs_no_barrier(const gpu::Access& before, const gpu::Access& after) {
    if (gpu::writes(before.access) || gpu::writes(after.access) || before.layout != after.layout) return false;
    const bool all_stages = before.stages == VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    const bool all_reads = (before.access & VK_ACCESS_2_MEMORY_READ_BIT) != 0;
    return (all_stages || (after.stages & ~before.stages) == 0) && (all_reads || (after.access & ~before.access) == 0);
}

VkImageMemoryBarrier2 image_barrier(const gpu::Image& image, const Barrier& barrier, const gpu::Access& before) {
    VkImageMemoryBarrier2 result{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
    result.srcStageMask = before.stages;
    result.srcAccessMask = before.access;
    result.dstStageMask = barrier.after.stages;
    result.dstAccessMask = barrier.after.access;
    result.oldLayout = before.layout;
    result.newLayout = barrier.after.layout;
    result.srcQueueFamilyIndex = result.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    result.image = image.handle();
    result.subresourceRange = {gpu::format_info(image.format()).aspect, barrier.base_mip, barrier.mips,
                               barrier.base_layer, barrier.layers};
    return result;
}

/// Values that show wherever they are read by mistake: NaN, all bits set, or magenta where the format has no NaN.
VkClearColorValue poison_color(VkFormat format) {
    VkClearColorValue value{};
    switch (gpu::format_info(format).kind) {
        case gpu::FormatKind::integer:
            std::ranges::fill(value.uint32, ~0u);
            break;
        case gpu::FormatKind::normalized:
            value = {{1.0f, 0.0f, 1.0f, 1.0f}};
            break;
        default:
            std::ranges::fill(value.float32, std::numeric_limits<float>::quiet_NaN());
    }
    return value;
}
constexpr std::uint32_t poison_word = 0xffffffffu;  // NaN as a float and as two halves

}  // namespace

const gpu::Image& PassContext::image(ImageHandle handle) const {
    return executor_.image(handle);
}
const gpu::Buffer& PassContext::buffer(BufferHandle handle) const {
    return executor_.buffer(handle);
}
gpu::Device& PassContext::device() const {
    return executor_.device();
}

Result<void> Executor::set_graph(const Graph& graph) {
    CompileOptions options;
    options.alias = settings_.alias;
    options.memory_requirements = [this](const Resource& resource) {
        VkMemoryRequirements requirements = resource.is_image
                                                ? gpu::Image::memory_requirements(device_, resource.image)
                                                : gpu::Buffer::memory_requirements(device_, resource.buffer);
        // Images and buffers may be neighbours in a heap.
        requirements.alignment = std::max(requirements.alignment, device_.limits().bufferImageGranularity);
        return requirements;
    };
    auto compiled = compile(graph, options);
    if (!compiled) return tl::unexpected(compiled.error());
    Frame frame;
    frame.compiled = std::move(*compiled);
    frame.slots.resize(frame.compiled.resources.size());
    if (auto made = make_transients(frame); !made) return made;
    if (auto made = make_persistents(frame); !made) return made;
    std::swap(frame_, frame);
    return {};
}

Result<void> Executor::make_transients(Frame& frame) const {
    for (const Heap& heap : frame.compiled.heaps) {
        auto block =
            gpu::MemoryBlock::create(device_, {heap.size, heap.alignment, heap.memory_types}, "transient resources");
        if (!block) return tl::unexpected(block.error());
        frame.heaps.push_back(std::move(*block));
    }
    for (const Placement& placement : frame.compiled.placements) {
        const Resource& resource = frame.compiled.resources[placement.resource];
        const gpu::SharedMemory memory = frame.heaps[placement.heap].at(placement.offset);
        Slot& slot = frame.slots[placement.resource];
        if (resource.is_image) {
            auto image = gpu::Image::create_in(device_, resource.image, memory);
            if (!image) return tl::unexpected(image.error());
            frame.images.push_back(std::make_unique<gpu::Image>(std::move(*image)));
            slot.image = frame.images.back().get();
        } else {
            auto buffer = gpu::Buffer::create_in(device_, resource.buffer, memory);
            if (!buffer) return tl::unexpected(buffer.error());
            frame.buffers.push_back(std::make_unique<gpu::Buffer>(std::move(*buffer)));
            slot.buffer = frame.buffers.back().get();
        }
    }
    return {};
}

Result<void> Executor::make_persistents(Frame& frame) const {
    for (std::uint32_t index = 0; index < frame.compiled.resources.size(); ++index) {
        const Resource& resource = frame.compiled.resources[index];
        if (resource.lifetime != Lifetime::persistent) continue;
        const std::string& name = resource.name();
        if (frame.persistent_images.contains(name) || frame.persistent_buffers.contains(name))
            return fail(fmt::format("persistent resource '{}'", name), "expected another name: there is one already");
        if (resource.is_image) {
            const auto known = frame_.persistent_images.find(name);
            auto& persistent = frame.persistent_images[name];
            if (known != frame_.persistent_images.end() && same(known->second->image.description(), resource.image)) {
                persistent = known->second;
            } else {
                auto image = gpu::Image::create(device_, resource.image);
                if (!image) return tl::unexpected(image.error());
                persistent = std::make_shared<PersistentImage>(PersistentImage{std::move(*image)});
            }
            frame.slots[index].image = &persistent->image;
        } else {
            const auto known = frame_.persistent_buffers.find(name);
            auto& persistent = frame.persistent_buffers[name];
            if (known != frame_.persistent_buffers.end() &&
                same(known->second->buffer.description(), resource.buffer)) {
                persistent = known->second;
            } else {
                auto buffer = gpu::Buffer::create(device_, resource.buffer);
                if (!buffer) return tl::unexpected(buffer.error());
                persistent = std::make_shared<PersistentBuffer>(PersistentBuffer{std::move(*buffer)});
            }
            frame.slots[index].buffer = &persistent->buffer;
        }
    }
    return {};
}

void Executor::bind(ImageHandle handle, const gpu::Image& image) {
    frame_.slots[handle.index].image = &image;
}
void Executor::bind(BufferHandle handle, const gpu::Buffer& buffer) {
    frame_.slots[handle.index].buffer = &buffer;
}
const gpu::Image& Executor::image(ImageHandle handle) const {
    return *frame_.slots[handle.index].image;
}
const gpu::Buffer& Executor::buffer(BufferHandle handle) const {
    return *frame_.slots[handle.index].buffer;
}

void Executor::reset_history() {
    for (auto& [name, image] : frame_.persistent_images) image->clear = true;
    for (auto& [name, buffer] : frame_.persistent_buffers) buffer->clear = true;
}

Result<void> Executor::begin(gpu::Commands& commands) {
    const CompiledGraph& compiled = frame_.compiled;
    for (const CompiledPass& pass : compiled.order)
        for (const ResourceUse& use : compiled.passes[pass.pass].uses)
            if (const Slot& slot = frame_.slots[use.resource]; !slot.image && !slot.buffer)
                return fail(fmt::format("pass '{}'", compiled.passes[pass.pass].name),
                            fmt::format("the imported '{}' is not bound", compiled.resources[use.resource].name()));
    clear_persistents(commands);
    poisoned_.assign(compiled.resources.size(), false);
    next_ = 0;
    return {};
}

Result<void> Executor::execute(gpu::Commands& commands, gpu::Timestamps* timestamps, Executor* beside) {
    if (auto begun = begin(commands); !begun) return begun;
    finish(commands, timestamps, beside);
    return {};
}

void Executor::finish(gpu::Commands& commands, gpu::Timestamps* timestamps, Executor* beside) {
    const CompiledGraph& compiled = frame_.compiled;
    while (next_ < compiled.order.size()) {
        Wait wait;
        add_next(commands, wait);
        if (beside) beside->add_next(commands, wait);
        wait.record(commands);
        record_next(commands, timestamps);
        if (beside) beside->record_next(commands, timestamps);
    }
    Wait wait;
    add(wait, compiled.final_barriers);
    wait.record(commands);
    for (const FinalState& final_state : compiled.final_states) {
        const Slot& slot = frame_.slots[final_state.resource];
        if (slot.image)
            slot.image->set_state(final_state.state);
        else
            slot.buffer->set_state(final_state.state);
    }
    swap_history();
}

void Executor::add_next(gpu::Commands& commands, Wait& wait) {
    if (next_ == frame_.compiled.order.size()) return;
    if (settings_.poison) poison(commands, next_);
    add(wait, frame_.compiled.order[next_].barriers);
}

void Executor::record_next(gpu::Commands& commands, gpu::Timestamps* timestamps) {
    const CompiledGraph& compiled = frame_.compiled;
    if (next_ == compiled.order.size()) return;
    PassContext context(commands, *this);
    do {
        const PassDeclaration& pass = compiled.passes[compiled.order[next_].pass];
        commands.begin_label(pass.name);
        const std::uint32_t scope = timestamps ? timestamps->begin(commands, pass.name) : 0;
        if (pass.execute) pass.execute(context);
        if (timestamps) timestamps->end(commands, scope);
        commands.end_label();
        ++next_;
    } while (next_ < compiled.order.size() && compiled.order[next_].barriers.empty());
}

void Executor::add(Wait& wait, const std::vector<Barrier>& barriers) const {
    for (const Barrier& barrier : barriers) {
        const Slot& slot = frame_.slots[barrier.resource];
        gpu::Access before = barrier.before;
        if (settings_.poison && barrier.discard) before = cleared;
        if (barrier.external) {
            before = slot.image ? slot.image->state() : slot.buffer->state();
            // Nothing was done yet but by the CPU, whose writes each submission sees.
            if (slot.buffer && before.stages == VK_PIPELINE_STAGE_2_NONE) continue;
            if (needs_no_barrier(before, barrier.after)) continue;
            // A read says nothing of the write before it, which other stages may not have seen yet.
            if (!gpu::writes(before.access) && before.stages != VK_PIPELINE_STAGE_2_NONE)
                before.access |= VK_ACCESS_2_MEMORY_WRITE_BIT;
        }
        if (slot.image) {
            wait.images.push_back(image_barrier(*slot.image, barrier, before));
            if (barrier.discard && !settings_.poison) wait.images.back().oldLayout = VK_IMAGE_LAYOUT_UNDEFINED;
        } else {
            wait.memory.srcStageMask |= before.stages;
            wait.memory.srcAccessMask |= before.access;
            wait.memory.dstStageMask |= barrier.after.stages;
            wait.memory.dstAccessMask |= barrier.after.access;
        }
    }
}

void Executor::Wait::record(gpu::Commands& commands) const {
    const bool any_memory = memory.dstStageMask != 0;
    if (images.empty() && !any_memory) return;
    commands.barriers(images, {&memory, any_memory ? 1u : 0u});
}

void Executor::clear_persistents(gpu::Commands& commands) {
    for (auto& [name, persistent] : frame_.persistent_images) {
        if (!persistent->clear) continue;
        const gpu::Image& image = persistent->image;
        gpu::Access before = everything;
        before.layout = VK_IMAGE_LAYOUT_UNDEFINED;
        commands.barrier({&image}, before, cleared);
        if (gpu::format_info(image.format()).kind == gpu::FormatKind::depth)
            commands.clear_depth({&image}, 0.0f);
        else
            commands.clear({&image}, VkClearColorValue{});
        image.set_state(cleared);
        persistent->clear = false;
    }
    for (auto& [name, persistent] : frame_.persistent_buffers) {
        if (!persistent->clear) continue;
        commands.memory_barrier(everything, cleared);
        commands.fill(persistent->buffer, 0);
        persistent->buffer.set_state({cleared.stages, cleared.access, VK_IMAGE_LAYOUT_UNDEFINED});
        persistent->clear = false;
    }
}

void Executor::poison(gpu::Commands& commands, std::uint32_t position) {
    for (const Barrier& barrier : frame_.compiled.order[position].barriers) {
        if (!barrier.discard || poisoned_[barrier.resource]) continue;
        poisoned_[barrier.resource] = true;  // all its parts at once
        const Slot& slot = frame_.slots[barrier.resource];
        if (slot.buffer) {
            commands.memory_barrier(everything, cleared);
            commands.fill(*slot.buffer, poison_word);
            continue;
        }
        commands.barrier({slot.image}, everything, cleared);
        if (gpu::format_info(slot.image->format()).kind == gpu::FormatKind::depth)
            commands.clear_depth({slot.image}, 0.5f);
        else
            commands.clear({slot.image}, poison_color(slot.image->format()));
    }
}

void Executor::swap_history() {
    const CompiledGraph& compiled = frame_.compiled;
    for (std::uint32_t index = 0; index < compiled.resources.size(); ++index) {
        const Resource& previous = compiled.resources[index];
        if (previous.history_of == ~0u) continue;
        const Resource& current = compiled.resources[previous.history_of];
        std::swap(frame_.persistent_images[current.name()], frame_.persistent_images[previous.name()]);
        std::swap(frame_.slots[previous.history_of], frame_.slots[index]);
    }
}

}  // namespace heliodon::graph
