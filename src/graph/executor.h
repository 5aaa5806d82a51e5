#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "gpu/commands.h"
#include "gpu/device.h"
#include "gpu/memory_block.h"
#include "gpu/timestamps.h"
#include "graph/compiled_graph.h"

namespace heliodon::graph {

class Executor;

/// What a pass gets when it records: its commands and the real resources behind its handles.
class PassContext {
public:
    gpu::Commands& commands;
    [[nodiscard]] const gpu::Image& image(ImageHandle handle) const;
    [[nodiscard]] const gpu::Buffer& buffer(BufferHandle handle) const;
    [[nodiscard]] gpu::Device& device() const;

private:
    friend class Executor;
    PassContext(gpu::Commands& commands_, const Executor& executor) : commands(commands_), executor_(executor) {}
    const Executor& executor_;
};

struct ExecutorSettings {
    bool poison =
        false;  ///< fill transient memory with NaN before its first use each frame, to find uninitialised reads
    bool alias = true;
};

/// Runs a compiled graph: owns its transient and persistent resources, records barriers, labels and timestamps.
/// Persistent resources survive set_graph() when name and description stay the same.
class Executor {
public:
    explicit Executor(gpu::Device& device, ExecutorSettings settings = {}) : device_(device), settings_(settings) {}
    Executor(const Executor&) = delete;
    Executor& operator=(const Executor&) = delete;

    /// Compiles and makes the resources. On an error the graph set before stays.
    [[nodiscard]] Result<void> set_graph(const Graph& graph);
    /// The resource behind an imported handle, until bound anew; it must live until the frame is complete.
    void bind(ImageHandle handle, const gpu::Image& image);
    void bind(BufferHandle handle, const gpu::Buffer& buffer);
    /// Records one frame. Errors: an imported resource not bound; what passes report is kept by `commands`.
    /// `beside`: a graph that was begun and shares nothing with this one but what both only read. It goes on with each wait
    /// of this one, so that both wait together and their passes run side by side.
    [[nodiscard]] Result<void> execute(gpu::Commands& commands, gpu::Timestamps* timestamps = nullptr, Executor* beside = nullptr);
    /// A frame that is recorded beside others: begin() it, hand it to their execute(), finish() what is left.
    [[nodiscard]] Result<void> begin(gpu::Commands& commands);
    void finish(gpu::Commands& commands, gpu::Timestamps* timestamps = nullptr) { finish(commands, timestamps, nullptr); }

    /// The real resource; exported, persistent and imported ones may be read after the frame. After execute() a
    /// history's `previous` is what this frame wrote as `current`.
    [[nodiscard]] const gpu::Image& image(ImageHandle handle) const;
    [[nodiscard]] const gpu::Buffer& buffer(BufferHandle handle) const;
    [[nodiscard]] const CompiledGraph& compiled() const { return frame_.compiled; }
    [[nodiscard]] gpu::Device& device() const { return device_; }
    /// Fills persistent and history resources with zeros again before the next frame.
    void reset_history();

private:
    /// A persistent resource and whether it still has to be filled with zeros.
    struct PersistentImage {
        gpu::Image image;
        bool clear = true;
    };
    struct PersistentBuffer {
        gpu::Buffer buffer;
        bool clear = true;
    };
    struct Slot {
        const gpu::Image* image = nullptr;
        const gpu::Buffer* buffer = nullptr;
    };
    /// A compiled graph with all that belongs to it; persistent resources pass from one to the next.
    struct Frame {
        CompiledGraph compiled;
        std::vector<gpu::MemoryBlock> heaps;  // before what lies in them: destroyed after it
        std::vector<std::unique_ptr<gpu::Image>> images;
        std::vector<std::unique_ptr<gpu::Buffer>> buffers;
        std::map<std::string, std::shared_ptr<PersistentImage>> persistent_images;
        std::map<std::string, std::shared_ptr<PersistentBuffer>> persistent_buffers;
        std::vector<Slot> slots;  // by resource
    };
    [[nodiscard]] Result<void> make_transients(Frame& frame) const;
    [[nodiscard]] Result<void> make_persistents(Frame& frame) const;
    void clear_persistents(gpu::Commands& commands);
    void poison(gpu::Commands& commands, std::uint32_t position);
    /// What one vkCmdPipelineBarrier2 waits for.
    struct Wait {
        std::vector<VkImageMemoryBarrier2> images;
        VkMemoryBarrier2 memory{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2, nullptr, 0, 0, 0, 0};
        void record(gpu::Commands& commands) const;
    };
    void add(Wait& wait, const std::vector<Barrier>& barriers) const;
    /// What the next passes wait for.
    void add_next(gpu::Commands& commands, Wait& wait);
    /// The next passes up to one that waits for more.
    void record_next(gpu::Commands& commands, gpu::Timestamps* timestamps);
    void finish(gpu::Commands& commands, gpu::Timestamps* timestamps, Executor* beside);
    void swap_history();

    gpu::Device& device_;
    ExecutorSettings settings_;
    Frame frame_;
    std::uint32_t next_ = 0;      // position of the pass to be recorded next
    std::vector<bool> poisoned_;  // by resource, in this frame
};

}  // namespace heliodon::graph
