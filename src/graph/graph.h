#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/image.h"
#include "graph/usage.h"

namespace heliodon::gpu {
class Commands;
}

namespace heliodon::graph {

class PassContext;

/// Names a resource of one Graph.
struct ImageHandle {
    std::uint32_t index = ~0u;
    explicit operator bool() const { return index != ~0u; }
    friend bool operator==(ImageHandle, ImageHandle) = default;
};
struct BufferHandle {
    std::uint32_t index = ~0u;
    explicit operator bool() const { return index != ~0u; }
    friend bool operator==(BufferHandle, BufferHandle) = default;
};
struct PassHandle {
    std::uint32_t index = ~0u;
};

/// A part of an image: a range of mips and layers.
struct ImagePart {
    ImagePart(ImageHandle image_) : image(image_) {}
    ImagePart(ImageHandle image_, std::uint32_t base_mip_, std::uint32_t mips_, std::uint32_t base_layer_ = 0,
              std::uint32_t layers_ = gpu::all_remaining)
        : image(image_), base_mip(base_mip_), mips(mips_), base_layer(base_layer_), layers(layers_) {}

    ImageHandle image;
    std::uint32_t base_mip = 0, mips = gpu::all_remaining;
    std::uint32_t base_layer = 0, layers = gpu::all_remaining;
};

enum class Lifetime {
    transient,   ///< of one frame; its memory is shared with others
    persistent,  ///< keeps its content to the next frame; zero at first; never aliases
    imported,    ///< somebody else's, bound with Executor::bind; never aliases
};

struct Resource {
    bool is_image = true;
    Lifetime lifetime = Lifetime::transient;
    bool exported = false;
    std::optional<Usage> final_usage;
    gpu::ImageDescription image;     ///< usage flags are added by the graph
    gpu::BufferDescription buffer;   ///< as above
    gpu::Access initial;             ///< imported: its state when the frame begins (Executor takes the real one)
    std::uint32_t history_of = ~0u;  ///< this is the previous frame's content of that resource

    [[nodiscard]] const std::string& name() const { return is_image ? image.name : buffer.name; }
    [[nodiscard]] std::uint32_t mips() const { return is_image ? image.mips : 1; }
    [[nodiscard]] std::uint32_t layers() const { return is_image ? image.layers : 1; }
};

/// One declared use of a resource (or a part of it) by a pass.
struct ResourceUse {
    std::uint32_t resource = 0;
    Usage usage = Usage::sampled;
    bool reads = false, writes = false;
    std::uint32_t base_mip = 0, mips = 1, base_layer = 0, layers = 1;  ///< resolved: never all_remaining
};

struct PassDeclaration {
    std::string name;
    PassKind kind = PassKind::compute;
    bool side_effect = false;
    std::vector<ResourceUse> uses;
    std::vector<std::uint32_t> after;  ///< passes named by PassBuilder::after
    std::function<void(PassContext&)> execute;
};

/// Declares what one pass reads and writes.
class PassBuilder {
public:
    /// The content is needed. Usages that write are declared with write() or read_write().
    PassBuilder& read(ImagePart image, Usage usage);
    PassBuilder& read(BufferHandle buffer, Usage usage);
    /// New content; what was there before in other texels stays, if it was ever written.
    PassBuilder& write(ImagePart image, Usage usage);
    PassBuilder& write(BufferHandle buffer, Usage usage);
    /// The old content is needed and changed.
    PassBuilder& read_write(ImagePart image, Usage usage);
    PassBuilder& read_write(BufferHandle buffer, Usage usage);
    /// The pass is never culled (it has an effect outside the graph).
    PassBuilder& side_effect();
    /// The pass runs after another one, whatever they share.
    PassBuilder& after(PassHandle pass);

private:
    friend class Graph;
    PassBuilder(class Graph& graph, std::uint32_t pass) : graph_(graph), pass_(pass) {}
    PassBuilder& use(ImagePart image, Usage usage, bool reads, bool writes);
    PassBuilder& use(BufferHandle buffer, Usage usage, bool reads, bool writes);
    void declare(const ResourceUse& use);

    Graph& graph_;
    std::uint32_t pass_;
};

/// What is to be done in a frame: resources, and passes that declare how they use them. Declaring makes no
/// Vulkan call. A pass that reads a resource runs after the passes declared before it that write it, or, if there
/// are none and the resource is transient, after those declared later. Build it once, compile it, execute it each
/// frame.
class Graph {
public:
    ImageHandle create_image(gpu::ImageDescription description);
    BufferHandle create_buffer(gpu::BufferDescription description);
    ImageHandle create_persistent_image(gpu::ImageDescription description);
    BufferHandle create_persistent_buffer(gpu::BufferDescription description);
    /// Two images that change places every frame: `previous` holds what was written to `current` last frame.
    struct History {
        ImageHandle current, previous;
    };
    History create_history(gpu::ImageDescription description);
    /// Somebody else's resource. `initial`: as it is when the frame begins; Executor takes the state that the bound
    /// resource itself tracks.
    ImageHandle import_image(gpu::ImageDescription description, gpu::Access initial = {});
    BufferHandle import_buffer(gpu::BufferDescription description, gpu::Access initial = {});

    /// The content is wanted after the frame (read back, say): its writers are not culled, it does not alias, and the
    /// frame ends with it ready for `final_usage` (by default as its last pass left it).
    void export_image(ImageHandle image, std::optional<Usage> final_usage = {});
    void export_buffer(BufferHandle buffer, std::optional<Usage> final_usage = {});

    /// `setup` declares at once; `execute` is called each frame that the pass is not culled.
    PassHandle add_pass(std::string name, PassKind kind, const std::function<void(PassBuilder&)>& setup,
                        std::function<void(PassContext&)> execute);

    [[nodiscard]] const std::vector<Resource>& resources() const { return resources_; }
    [[nodiscard]] const std::vector<PassDeclaration>& passes() const { return passes_; }
    [[nodiscard]] const gpu::ImageDescription& description(ImageHandle image) const {
        return resources_[image.index].image;
    }
    [[nodiscard]] const gpu::BufferDescription& description(BufferHandle buffer) const {
        return resources_[buffer.index].buffer;
    }
    /// Mistakes of declaration (a bad handle, a range outside the image …), reported by compile().
    [[nodiscard]] const std::vector<Error>& errors() const { return errors_; }

private:
    friend class PassBuilder;
    std::uint32_t add(Resource resource);
    void add_error(const std::string& pass, std::string message);

    std::vector<Resource> resources_;
    std::vector<PassDeclaration> passes_;
    std::vector<Error> errors_;
};

}  // namespace heliodon::graph
