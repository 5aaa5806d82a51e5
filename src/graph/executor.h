#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "gpu/commands.h"
#include "gpu/device.h"
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
    bool poison = false;  ///< fill transient memory with NaN before its first use each frame, to find uninitialised reads
    bool alias = true;
};

/// Runs a compiled graph: owns its transient and persistent resources, records barriers, labels and timestamps.
/// Persistent resources survive set_graph() when name and description stay the same.
class Executor {
public:
    explicit Executor(gpu::Device& device, ExecutorSettings settings = {}) : device_(device), settings_(settings) {}
    ~Executor();
    Executor(const Executor&) = delete;
    Executor& operator=(const Executor&) = delete;

    /// Compiles and makes the resources. On an error the graph set before stays.
    [[nodiscard]] Result<void> set_graph(const Graph& graph);
    /// The resource behind an imported handle, until bound anew; it must live until the frame is complete.
    void bind(ImageHandle handle, const gpu::Image& image);
    void bind(BufferHandle handle, const gpu::Buffer& buffer);
    /// Records one frame. Errors: an imported resource not bound; what passes report is kept by `commands`.
    [[nodiscard]] Result<void> execute(gpu::Commands& commands, gpu::Timestamps* timestamps = nullptr);

    /// The real resource; exported, persistent and imported ones may be read after the frame.
    [[nodiscard]] const gpu::Image& image(ImageHandle handle) const;
    [[nodiscard]] const gpu::Buffer& buffer(BufferHandle handle) const;
    [[nodiscard]] const CompiledGraph& compiled() const { return compiled_; }
    [[nodiscard]] gpu::Device& device() const { return device_; }
    /// Fills persistent and history resources with zeros again before the next frame.
    void reset_history() { clear_persistent_ = true; }

private:
    struct PersistentImage;
    struct PersistentBuffer;
    struct HeapMemory;
    struct Slot {
        const gpu::Image* image = nullptr;
        const gpu::Buffer* buffer = nullptr;
    };
    [[nodiscard]] Result<void> make_resources(const CompiledGraph& compiled);
    void swap_history();
    void clear_persistent(gpu::Commands& commands);
    void poison(gpu::Commands& commands, std::uint32_t resource);
    void record(gpu::Commands& commands, const std::vector<Barrier>& barriers);
    void release_transients();

    gpu::Device& device_;
    ExecutorSettings settings_;
    CompiledGraph compiled_;
    std::vector<Slot> slots_;  // by resource
    std::vector<std::unique_ptr<gpu::Image>> transient_images_;
    std::vector<std::unique_ptr<gpu::Buffer>> transient_buffers_;
    std::map<std::string, std::unique_ptr<gpu::Image>> persistent_images_;
    std::map<std::string, std::unique_ptr<gpu::Buffer>> persistent_buffers_;
    std::vector<VmaAllocation_T*> heaps_;
    bool clear_persistent_ = true;
};

}  // namespace heliodon::graph
