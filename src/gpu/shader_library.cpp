#include <fmt/format.h>

#include <algorithm>

#include "gpu/shader.h"

namespace heliodon::gpu {
namespace {

std::filesystem::file_time_type write_time(const std::filesystem::path& file) {
    std::error_code error;
    const auto time = std::filesystem::last_write_time(file, error);
    return error ? std::filesystem::file_time_type::min() : time;
}

Result<std::shared_ptr<const Shader>> make_shader(const std::string& name, std::vector<std::uint32_t> code) {
    auto reflection = reflect(name, code);
    if (!reflection) return tl::unexpected(reflection.error());
    return std::make_shared<const Shader>(Shader{name, std::move(code), std::move(*reflection)});
}

}  // namespace

ShaderLibrary::ShaderLibrary(std::span<const EmbeddedShader> embedded, std::filesystem::path directory)
    : directory_(std::move(directory)) {
    add(embedded);
}

void ShaderLibrary::add(std::span<const EmbeddedShader> embedded) {
    for (const EmbeddedShader& shader : embedded) embedded_[std::string(shader.name)] = shader.code;
}

std::vector<std::string> ShaderLibrary::names() const {
    std::vector<std::string> names;
    for (const auto& [name, code] : embedded_) names.push_back(name);
    return names;
}

Result<ShaderLibrary::Loaded> ShaderLibrary::load(const std::string& name) const {
    Loaded loaded;
    std::error_code error;
    if (!directory_.empty() && std::filesystem::is_regular_file(directory_ / name, error)) {
        std::vector<std::filesystem::path> sources;
        auto code = compile_glsl(directory_ / name, directory_, &sources);
        if (!code) return tl::unexpected(code.error());
        auto shader = make_shader(name, std::move(*code));
        if (!shader) return tl::unexpected(shader.error());
        loaded.shader = std::move(*shader);
        for (const auto& source : sources) loaded.sources[source] = write_time(source);
        return loaded;
    }
    const auto found = embedded_.find(name);
    if (found == embedded_.end())
        return fail(name, directory_.empty()
                              ? "there is no such shader"
                              : fmt::format("there is no such shader, built in or in {}", directory_.string()));
    auto shader = make_shader(name, {found->second.begin(), found->second.end()});
    if (!shader) return tl::unexpected(shader.error());
    loaded.shader = std::move(*shader);
    return loaded;
}

Result<std::shared_ptr<const Shader>> ShaderLibrary::find(const std::string& name) {
    if (const auto known = loaded_.find(name); known != loaded_.end()) return known->second.shader;
    auto loaded = load(name);
    if (!loaded) return tl::unexpected(loaded.error());
    return loaded_.emplace(name, std::move(*loaded)).first->second.shader;
}

ShaderReload ShaderLibrary::reload() {
    ShaderReload reload;
    for (auto& [name, known] : loaded_) {
        const bool changed = std::ranges::any_of(
            known.sources, [](const auto& source) { return write_time(source.first) != source.second; });
        if (!changed) continue;
        auto loaded = load(name);
        if (!loaded) {
            reload.errors.push_back(loaded.error());
            continue;
        }
        known = std::move(*loaded);
        reload.changed.push_back(name);
    }
    return reload;
}

}  // namespace heliodon::gpu
