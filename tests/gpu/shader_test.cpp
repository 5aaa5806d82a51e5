#include <filesystem>
#include <fstream>

#include "gpu_test.h"
#include "shaders/multiply_add_shared.h"

namespace heliodon::gpu {
namespace {

class ShaderReloading : public GpuTest {
protected:
    ShaderReloading() : directory(std::filesystem::path(testing::TempDir()) / "heliodon_shader_reload") {
        std::filesystem::remove_all(directory);
        std::filesystem::create_directories(directory / "test");
        write("test/constant.h", "#define CONSTANT 5\n");
        write("test/constant.comp", source("CONSTANT"));
    }
    ~ShaderReloading() override { std::filesystem::remove_all(directory); }

    static std::string source(const std::string& expression) {
        return "#version 460\n#extension GL_GOOGLE_include_directive : require\n#include \"constant.h\"\n"
               "layout(local_size_x = 1) in;\nlayout(binding = 0) buffer Values { uint values[]; };\n"
               "void main() {\n    values[0] = " +
               expression + ";\n}\n";
    }
    void write(const std::string& name, const std::string& text) {
        const auto file = directory / name;
        std::ofstream(file) << text;
        // File systems may count time in steps longer than a test takes.
        std::filesystem::last_write_time(
            file, std::filesystem::file_time_type::clock::now() + std::chrono::seconds(++writes));
    }
    std::uint32_t result(const ComputePipeline& pipeline) {
        const Buffer values = buffer("values", 4);
        expect_ok(device().run("constant", [&](Commands& commands) {
            commands.dispatch(pipeline, NoPushConstants{}, {values}, {1, 1, 1});
        }));
        return value_of(device().read_back_as<std::uint32_t>(values))[0];
    }

    std::filesystem::path directory;
    int writes = 0;
};

TEST_F(ShaderReloading, FollowsEditsAndKeepsThePipelineOnErrors) {
    Pipelines live(device(), ShaderLibrary(tests::embedded_shaders(), directory));
    const ComputePipeline& pipeline = *value_of(live.compute("test/constant.comp"));
    EXPECT_EQ(result(pipeline), 5u);
    EXPECT_TRUE(live.reload().changed.empty());

    write("test/constant.h", "#define CONSTANT 6\n");
    EXPECT_EQ(live.reload().changed, std::vector<std::string>{"test/constant.comp"}) << "an included file counts too";
    EXPECT_EQ(result(pipeline), 6u);

    write("test/constant.comp", source("no_such_name"));
    const ShaderReload broken = live.reload();
    EXPECT_TRUE(broken.changed.empty());
    ASSERT_EQ(broken.errors.size(), 1u);
    EXPECT_EQ(broken.errors[0].where, (directory / "test/constant.comp").string() + ":7");
    EXPECT_NE(broken.errors[0].message.find("no_such_name"), std::string::npos) << broken.errors[0].message;
    EXPECT_EQ(result(pipeline), 6u) << "the old code stays in use";

    write("test/constant.comp", source("CONSTANT + 1"));
    EXPECT_EQ(live.reload().changed.size(), 1u);
    EXPECT_EQ(result(pipeline), 7u);
}

TEST_F(ShaderReloading, LocatesErrorsInIncludedFiles) {
    write("test/constant.h", "\n#define CONSTANT 1\nvec3 wrong() { return 1; }\n");
    const auto code = compile_glsl(directory / "test/constant.comp", directory);
    ASSERT_FALSE(code);
    EXPECT_EQ(code.error().where, (directory / "test/constant.h").string() + ":3") << code.error().message;
}

TEST_F(ShaderReloading, FindsIncludesBelowItsFolderToo) {
    std::string text = source("CONSTANT");
    text.replace(text.find("\"constant.h\""), 12, "\"test/constant.h\"");
    write("test/constant.comp", text);
    std::vector<std::filesystem::path> files;
    EXPECT_TRUE(compile_glsl(directory / "test/constant.comp", directory, &files));
    EXPECT_EQ(files, (std::vector{directory / "test/constant.comp", directory / "test/constant.h"}));
}

TEST_F(ShaderReloading, SaysWhichIncludeIsMissing) {
    std::filesystem::remove(directory / "test/constant.h");
    const auto code = compile_glsl(directory / "test/constant.comp", directory);
    ASSERT_FALSE(code);
    EXPECT_NE(code.error().text().find("constant.h"), std::string::npos) << code.error().text();
}

TEST_F(ShaderReloading, CompilesWhatWasBuiltInToTheSameInterface) {
    ShaderLibrary built_in(tests::embedded_shaders());
    ShaderLibrary live(tests::embedded_shaders(), HELIODON_SOURCE_DIR "/tests/gpu");
    for (const std::string& name : built_in.names()) {
        const auto a = value_of(built_in.find(name)), b = value_of(live.find(name));
        EXPECT_EQ(a->reflection.push_constant_bytes, b->reflection.push_constant_bytes) << name;
        ASSERT_EQ(a->reflection.bindings.size(), b->reflection.bindings.size()) << name;
        for (std::size_t i = 0; i < a->reflection.bindings.size(); ++i)
            EXPECT_EQ(a->reflection.bindings[i].name, b->reflection.bindings[i].name) << name;
    }
}

TEST_F(ShaderReloading, RefusesUnknownNamesAndDamagedCode) {
    ShaderLibrary library(tests::embedded_shaders());
    EXPECT_EQ(library.find("shaders/none.comp").error().text(), "shaders/none.comp: there is no such shader");
    const std::vector<std::uint32_t> damaged = {1, 2, 3, 4, 5, 6, 7};
    EXPECT_FALSE(reflect("damaged", damaged));
}

}  // namespace
}  // namespace heliodon::gpu
