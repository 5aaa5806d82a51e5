#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gpu/vulkan.h"

namespace heliodon::gpu {

/// SPIR-V compiled at build time (cmake/HeliodonShaders.cmake): `name` is the file's path below its source folder.
struct EmbeddedShader {
    std::string_view name;
    std::span<const std::uint32_t> code;
};

/// One resource that a shader declares.
struct ShaderBinding {
    std::string name;
    std::uint32_t set = 0, binding = 0;
    VkDescriptorType type = VK_DESCRIPTOR_TYPE_MAX_ENUM;
    std::uint32_t count = 1;                                  ///< array length; 0: of run-time length
    VkImageViewType view_type = VK_IMAGE_VIEW_TYPE_MAX_ENUM;  ///< images only
    VkShaderStageFlags stages = 0;
};

/// What the compiler knows of a shader's interface.
struct ShaderReflection {
    VkShaderStageFlagBits stage = VK_SHADER_STAGE_COMPUTE_BIT;
    std::vector<ShaderBinding> bindings;  ///< by set, then binding
    std::uint32_t push_constant_bytes = 0;
    std::array<std::uint32_t, 3> workgroup_size{1, 1, 1};             ///< compute; with the default specialization
    std::array<std::uint32_t, 3> workgroup_constants{~0u, ~0u, ~0u};  ///< constant_id of each side, or none
};
[[nodiscard]] Result<ShaderReflection> reflect(const std::string& name, std::span<const std::uint32_t> code);

struct Shader {
    std::string name;
    std::vector<std::uint32_t> code;
    ShaderReflection reflection;
};

/// The stage that a file's ending names (.comp .vert .frag .geom .tesc .tese).
[[nodiscard]] Result<VkShaderStageFlagBits> stage_of(const std::string& name);

/// Compiles GLSL for Vulkan 1.3; #include finds files below `include_directory` or beside the includer, and
/// `dependencies` receives them. Errors carry file:line of the first message and all messages as text.
[[nodiscard]] Result<std::vector<std::uint32_t>> compile_glsl(
    const std::filesystem::path& file, const std::filesystem::path& include_directory,
    std::vector<std::filesystem::path>* dependencies = nullptr);

struct ShaderReload {
    std::vector<std::string> changed;  ///< names whose code is new
    std::vector<Error> errors;         ///< what did not compile; the old code stays
};

/// Shaders by name ("passes/shade/shade.comp"): embedded ones, or the same names compiled from a source folder.
class ShaderLibrary {
public:
    ShaderLibrary() = default;
    /// `directory` empty: only the embedded shaders. Otherwise `directory/name` is compiled on first use.
    explicit ShaderLibrary(std::span<const EmbeddedShader> embedded, std::filesystem::path directory = {});

    void add(std::span<const EmbeddedShader> embedded);
    [[nodiscard]] Result<std::shared_ptr<const Shader>> find(const std::string& name);
    [[nodiscard]] std::vector<std::string> names() const;
    /// Compiles again what was used and whose files (includes too) changed since.
    [[nodiscard]] ShaderReload reload();
    [[nodiscard]] const std::filesystem::path& directory() const { return directory_; }

private:
    struct Loaded {
        std::shared_ptr<const Shader> shader;
        std::map<std::filesystem::path, std::filesystem::file_time_type> sources;
    };
    [[nodiscard]] Result<Loaded> load(const std::string& name) const;

    std::map<std::string, std::span<const std::uint32_t>, std::less<>> embedded_;
    std::filesystem::path directory_;
    std::map<std::string, Loaded> loaded_;
};

}  // namespace heliodon::gpu
