#include <fmt/format.h>
#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <memory>
#include <optional>
#include <sstream>

#include "gpu/shader.h"

namespace heliodon::gpu {
namespace {

constexpr int glsl_version = 460;

struct Stage {
    const char* ending;
    VkShaderStageFlagBits stage;
    EShLanguage language;
};
constexpr std::array stages = {
    Stage{".comp", VK_SHADER_STAGE_COMPUTE_BIT, EShLangCompute},
    Stage{".vert", VK_SHADER_STAGE_VERTEX_BIT, EShLangVertex},
    Stage{".frag", VK_SHADER_STAGE_FRAGMENT_BIT, EShLangFragment},
    Stage{".geom", VK_SHADER_STAGE_GEOMETRY_BIT, EShLangGeometry},
    Stage{".tesc", VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT, EShLangTessControl},
    Stage{".tese", VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT, EShLangTessEvaluation},
};

Result<Stage> find_stage(const std::string& name) {
    const auto found = std::ranges::find_if(stages, [&](const Stage& stage) { return name.ends_with(stage.ending); });
    if (found == stages.end())
        return fail(name, "expected a name ending in .comp, .vert, .frag, .geom, .tesc or .tese");
    return *found;
}

std::optional<std::string> read_text(const std::filesystem::path& file) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error)) return std::nullopt;
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream text;
    if (!(text << stream.rdbuf())) return std::nullopt;
    return text.str();
}

/// Finds included files beside the includer or below one folder, and remembers them.
class Includer : public glslang::TShader::Includer {
public:
    Includer(std::filesystem::path directory, std::vector<std::filesystem::path>* found)
        : directory_(std::move(directory)), found_(found) {}

    IncludeResult* includeLocal(const char* header, const char* includer, std::size_t) override {
        return open(std::filesystem::path(includer).parent_path() / header);
    }
    IncludeResult* includeSystem(const char* header, const char*, std::size_t) override {
        return open(directory_ / header);
    }
    void releaseInclude(IncludeResult*) override {}  // kept until the compilation is over

private:
    struct File {
        std::string text;
        std::unique_ptr<IncludeResult> result;
    };
    IncludeResult* open(const std::filesystem::path& path) {
        auto text = read_text(path);
        if (!text) return nullptr;
        if (found_) found_->push_back(path);
        auto file = std::make_unique<File>();
        file->text = std::move(*text);
        file->result = std::make_unique<IncludeResult>(path.lexically_normal().string(), file->text.data(),
                                                       file->text.size(), nullptr);
        files_.push_back(std::move(file));
        return files_.back()->result.get();
    }

    std::filesystem::path directory_;
    std::vector<std::filesystem::path>* found_;
    std::vector<std::unique_ptr<File>> files_;
};

/// glslang says "ERROR: file:line: text" a line; the first becomes the place, all of them the message.
tl::unexpected<Error> located_failure(const std::filesystem::path& file, const std::string& log) {
    std::string where = file.string(), message;
    std::istringstream lines(log);
    bool first = true;
    for (std::string line; std::getline(lines, line);) {
        constexpr std::string_view prefix = "ERROR: ";
        if (!line.starts_with(prefix) || line.find("compilation errors") != std::string::npos) continue;
        line.erase(0, prefix.size());
        const std::size_t end_of_line_number = line.find(": ");
        const std::string place = end_of_line_number == std::string::npos ? "" : line.substr(0, end_of_line_number);
        const std::size_t colon = place.rfind(':');
        const bool located = colon != std::string::npos && colon + 1 < place.size() &&
                             place.find_first_not_of("0123456789", colon + 1) == std::string::npos;
        if (first && located) {
            where = place;
            line.erase(0, end_of_line_number + 2);
        }
        message += (first ? "" : "\n") + line;
        first = false;
    }
    return fail(std::move(where), message.empty() ? "cannot compile: " + log : std::move(message));
}

/// glslang's process-wide tables, built once.
void initialize_glslang() {
    static const bool initialized = glslang::InitializeProcess();
    static_cast<void>(initialized);
}

}  // namespace

Result<VkShaderStageFlagBits> stage_of(const std::string& name) {
    auto stage = find_stage(name);
    if (!stage) return tl::unexpected(stage.error());
    return stage->stage;
}

Result<std::vector<std::uint32_t>> compile_glsl(const std::filesystem::path& file,
                                                const std::filesystem::path& include_directory,
                                                std::vector<std::filesystem::path>* dependencies) try {
    auto stage = find_stage(file.string());
    if (!stage) return tl::unexpected(stage.error());
    const auto text = read_text(file);
    if (!text) return fail(file.string(), "cannot read the shader");
    if (dependencies) dependencies->push_back(file);
    initialize_glslang();

    const std::string name = file.string();
    const char* source = text->data();
    const int length = static_cast<int>(text->size());
    const char* source_name = name.c_str();
    glslang::TShader shader(stage->language);
    shader.setStringsWithLengthsAndNames(&source, &length, &source_name, 1);
    shader.setEnvInput(glslang::EShSourceGlsl, stage->language, glslang::EShClientVulkan, glsl_version);
    shader.setEnvClient(glslang::EShClientVulkan, glslang::EShTargetVulkan_1_3);
    shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_6);
    const auto rules = static_cast<EShMessages>(EShMsgSpvRules | EShMsgVulkanRules);
    Includer includer(include_directory, dependencies);
    if (!shader.parse(GetDefaultResources(), glsl_version, false, rules, includer))
        return located_failure(file, shader.getInfoLog());
    glslang::TProgram program;
    program.addShader(&shader);
    if (!program.link(rules)) return located_failure(file, program.getInfoLog());
    std::vector<std::uint32_t> code;
    glslang::GlslangToSpv(*program.getIntermediate(stage->language), code);
    return code;
} catch (const std::exception& error) {
    return fail(file.string(), error.what());
}

}  // namespace heliodon::gpu
