#include "passes/common/scene_inputs.h"

#include <algorithm>

namespace heliodon::passes {
namespace {

constexpr std::uint32_t luminaire_binding = 26;  // luminaires.glsl

}  // namespace

std::vector<gpu::Binding> select_bindings(const gpu::Pipeline& pipeline, const SceneInputs& scene,
                                          std::span<const NumberedBinding> own) {
    std::vector<gpu::Binding> selected;
    for (const gpu::ShaderBinding& declared : pipeline.layout().bindings()) {
        const auto found = std::find_if(own.begin(), own.end(),
                                        [&](const NumberedBinding& b) { return b.first == declared.binding; });
        if (found != own.end()) selected.push_back(found->second);
        else if (declared.binding < scene.tables.size()) selected.push_back(scene.tables[declared.binding]);
        else if (declared.binding == luminaire_binding && scene.luminaires) selected.emplace_back(*scene.luminaires);
        // A binding that is missing here makes Commands refuse the call and name it.
    }
    return selected;
}

}  // namespace heliodon::passes
