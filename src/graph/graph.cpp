#include "graph/graph.h"

#include <fmt/format.h>

#include <algorithm>

namespace heliodon::graph {
namespace {

Resource image_resource(gpu::ImageDescription description, Lifetime lifetime) {
    Resource resource;
    resource.is_image = true;
    resource.lifetime = lifetime;
    resource.image = std::move(description);
    return resource;
}

Resource buffer_resource(gpu::BufferDescription description, Lifetime lifetime) {
    Resource resource;
    resource.is_image = false;
    resource.lifetime = lifetime;
    resource.buffer = std::move(description);
    return resource;
}

std::uint32_t resolved(std::uint32_t base, std::uint32_t count, std::uint32_t total) {
    return count == gpu::all_remaining ? total - std::min(base, total) : count;
}

}  // namespace

std::uint32_t Graph::add(Resource resource) {
    resources_.push_back(std::move(resource));
    return static_cast<std::uint32_t>(resources_.size() - 1);
}

void Graph::add_error(const std::string& pass, std::string message) {
    errors_.push_back({fmt::format("pass '{}'", pass), std::move(message)});
}

ImageHandle Graph::create_image(gpu::ImageDescription description) {
    return {add(image_resource(std::move(description), Lifetime::transient))};
}
BufferHandle Graph::create_buffer(gpu::BufferDescription description) {
    return {add(buffer_resource(std::move(description), Lifetime::transient))};
}
ImageHandle Graph::create_persistent_image(gpu::ImageDescription description) {
    return {add(image_resource(std::move(description), Lifetime::persistent))};
}
BufferHandle Graph::create_persistent_buffer(gpu::BufferDescription description) {
    return {add(buffer_resource(std::move(description), Lifetime::persistent))};
}

Graph::History Graph::create_history(gpu::ImageDescription description) {
    History history;
    history.current = create_persistent_image(description);
    description.name += " (previous)";
    history.previous = create_persistent_image(std::move(description));
    resources_[history.previous.index].history_of = history.current.index;
    return history;
}

ImageHandle Graph::import_image(gpu::ImageDescription description, gpu::Access initial) {
    Resource resource = image_resource(std::move(description), Lifetime::imported);
    resource.initial = initial;
    return {add(std::move(resource))};
}
BufferHandle Graph::import_buffer(gpu::BufferDescription description, gpu::Access initial) {
    Resource resource = buffer_resource(std::move(description), Lifetime::imported);
    resource.initial = initial;
    return {add(std::move(resource))};
}

void Graph::export_image(ImageHandle image, std::optional<Usage> final_usage) {
    if (image.index >= resources_.size()) return errors_.push_back({"export_image", "the handle names no resource"});
    resources_[image.index].exported = true;
    resources_[image.index].final_usage = final_usage;
}
void Graph::export_buffer(BufferHandle buffer, std::optional<Usage> final_usage) {
    if (buffer.index >= resources_.size()) return errors_.push_back({"export_buffer", "the handle names no resource"});
    resources_[buffer.index].exported = true;
    resources_[buffer.index].final_usage = final_usage;
}

PassHandle Graph::add_pass(std::string name, PassKind kind, const std::function<void(PassBuilder&)>& setup,
                           std::function<void(PassContext&)> execute) {
    const auto index = static_cast<std::uint32_t>(passes_.size());
    PassDeclaration& pass = passes_.emplace_back();
    pass.name = std::move(name);
    pass.kind = kind;
    pass.execute = std::move(execute);
    PassBuilder builder(*this, index);
    setup(builder);
    return {index};
}

PassBuilder& PassBuilder::read(ImagePart image, Usage usage) {
    return use(image, usage, true, false);
}
PassBuilder& PassBuilder::read(BufferHandle buffer, Usage usage) {
    return use(buffer, usage, true, false);
}
PassBuilder& PassBuilder::write(ImagePart image, Usage usage) {
    return use(image, usage, false, true);
}
PassBuilder& PassBuilder::write(BufferHandle buffer, Usage usage) {
    return use(buffer, usage, false, true);
}
PassBuilder& PassBuilder::read_write(ImagePart image, Usage usage) {
    return use(image, usage, true, true);
}
PassBuilder& PassBuilder::read_write(BufferHandle buffer, Usage usage) {
    return use(buffer, usage, true, true);
}

PassBuilder& PassBuilder::side_effect() {
    graph_.passes_[pass_].side_effect = true;
    return *this;
}

PassBuilder& PassBuilder::after(PassHandle pass) {
    PassDeclaration& declared = graph_.passes_[pass_];
    if (pass.index >= graph_.passes_.size())
        graph_.add_error(declared.name, "after() names no pass");
    else
        declared.after.push_back(pass.index);
    return *this;
}

PassBuilder& PassBuilder::use(ImagePart image, Usage usage, bool reads, bool writes) {
    const std::string& pass = graph_.passes_[pass_].name;
    if (image.image.index >= graph_.resources_.size() || !graph_.resources_[image.image.index].is_image) {
        graph_.add_error(pass, "an image handle names no image");
        return *this;
    }
    const Resource& resource = graph_.resources_[image.image.index];
    ResourceUse use{image.image.index, usage,       reads, writes, image.base_mip, image.mips,
                    image.base_layer,  image.layers};
    use.mips = resolved(image.base_mip, image.mips, resource.mips());
    use.layers = resolved(image.base_layer, image.layers, resource.layers());
    if (use.mips == 0 || use.layers == 0 || use.base_mip + use.mips > resource.mips() ||
        use.base_layer + use.layers > resource.layers())
        graph_.add_error(
            pass, fmt::format("image '{}' has {} mips and {} layers, not mips {}+{} of layers {}+{}", resource.name(),
                              resource.mips(), resource.layers(), use.base_mip, use.mips, use.base_layer, use.layers));
    else if (image_usage(usage) == 0)
        graph_.add_error(pass, fmt::format("image '{}' cannot be used as {}", resource.name(), usage_name(usage)));
    else
        declare(use);
    return *this;
}

PassBuilder& PassBuilder::use(BufferHandle buffer, Usage usage, bool reads, bool writes) {
    const std::string& pass = graph_.passes_[pass_].name;
    if (buffer.index >= graph_.resources_.size() || graph_.resources_[buffer.index].is_image)
        graph_.add_error(pass, "a buffer handle names no buffer");
    else if (buffer_usage(usage) == 0)
        graph_.add_error(pass, fmt::format("buffer '{}' cannot be used as {}", graph_.resources_[buffer.index].name(),
                                           usage_name(usage)));
    else
        declare({buffer.index, usage, reads, writes, 0, 1, 0, 1});
    return *this;
}

void PassBuilder::declare(const ResourceUse& use) {
    PassDeclaration& pass = graph_.passes_[pass_];
    const std::string& name = graph_.resources_[use.resource].name();
    if (use.writes && !usage_writes(use.usage))
        return graph_.add_error(pass.name,
                                fmt::format("'{}' is written as {}, which only reads", name, usage_name(use.usage)));
    if (use.reads && !use.writes && !usage_reads(use.usage))
        return graph_.add_error(pass.name,
                                fmt::format("'{}' is read as {}, which writes", name, usage_name(use.usage)));
    if (use.writes && !use.reads && use.usage == Usage::storage_read_write)
        return graph_.add_error(pass.name,
                                fmt::format("'{}' is only written, but as storage_read_write: use read_write()", name));
    if (use.reads && !use.writes && use.usage == Usage::storage_read_write)
        return graph_.add_error(pass.name,
                                fmt::format("'{}' is only read, but as storage_read_write: use read_write()", name));
    pass.uses.push_back(use);
}

}  // namespace heliodon::graph
