#include <algorithm>

#include "gpu/pipeline.h"

namespace heliodon::gpu {

Pipelines::Pipelines(Device& device, ShaderLibrary shaders) : device_(&device), shaders_(std::move(shaders)) {}

Result<ComputePipeline> Pipelines::make(const std::string& shader, const Specialization& specialization) {
    auto found = shaders_.find(shader);
    if (!found) return tl::unexpected(found.error());
    return ComputePipeline::create(*device_, *found, specialization);
}

Result<GraphicsPipeline> Pipelines::make(const GraphicsDescription& description) {
    std::vector<std::shared_ptr<const Shader>> shaders;
    for (const std::string& name : {description.vertex, description.geometry, description.fragment}) {
        if (name.empty()) continue;
        auto found = shaders_.find(name);
        if (!found) return tl::unexpected(found.error());
        shaders.push_back(std::move(*found));
    }
    return GraphicsPipeline::create(*device_, description, shaders);
}

Result<const ComputePipeline*> Pipelines::compute(const std::string& name, const Specialization& specialization) {
    for (const auto& known : compute_)
        if (known->shader == name && known->specialization == specialization) return &known->pipeline;
    auto made = make(name, specialization);
    if (!made) return tl::unexpected(made.error());
    compute_.push_back(std::make_unique<Compute>(Compute{name, specialization, std::move(*made)}));
    return &compute_.back()->pipeline;
}

Result<const GraphicsPipeline*> Pipelines::graphics(const GraphicsDescription& description) {
    for (const auto& known : graphics_)
        if (known->description.name == description.name) return &known->pipeline;
    auto made = make(description);
    if (!made) return tl::unexpected(made.error());
    graphics_.push_back(std::make_unique<Graphics>(Graphics{description, std::move(*made)}));
    return &graphics_.back()->pipeline;
}

ShaderReload Pipelines::reload() {
    ShaderReload reload = shaders_.reload();
    const auto changed = [&](const std::string& name) {
        return std::ranges::find(reload.changed, name) != reload.changed.end();
    };
    for (const auto& compute : compute_) {
        if (!changed(compute->shader)) continue;
        auto made = make(compute->shader, compute->specialization);
        if (made)
            compute->pipeline = std::move(*made);
        else
            reload.errors.push_back(made.error());
    }
    for (const auto& graphics : graphics_) {
        const GraphicsDescription& d = graphics->description;
        if (!changed(d.vertex) && !changed(d.fragment) && !changed(d.geometry)) continue;
        auto made = make(d);
        if (made)
            graphics->pipeline = std::move(*made);
        else
            reload.errors.push_back(made.error());
    }
    return reload;
}

}  // namespace heliodon::gpu
