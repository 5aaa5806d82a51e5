// The bidirectional kernel in GLSL. Drivers that run on the CPU take minutes to compile it: here it is only held to have
// been compiled for the device with all that it reads and writes.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "gpu/shader.h"
#include "test_trace_shaders.h"

namespace heliodon::tests {
namespace {

TEST(BidirectionalKernel, IsCompiledAsGlslToo) {
    const auto shaders = embedded_shaders();
    const auto found = std::find_if(shaders.begin(), shaders.end(), [](const gpu::EmbeddedShader& shader) {
        return shader.name == "shaders/bidirectional.comp";
    });
    ASSERT_NE(found, shaders.end());
    const auto reflection = gpu::reflect(std::string(found->name), found->code);
    ASSERT_TRUE(reflection) << reflection.error().text();
    std::set<std::uint32_t> bindings;
    for (const gpu::ShaderBinding& binding : reflection->bindings) bindings.insert(binding.binding);
    for (const std::uint32_t needed : {0, 1, 2, 3, 10, 13, 14, 15, 16, 17, 18}) EXPECT_TRUE(bindings.count(needed)) << needed;
}

}  // namespace
}  // namespace heliodon::tests
