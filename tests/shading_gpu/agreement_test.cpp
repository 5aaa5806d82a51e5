#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "gpu/commands.h"
#include "gpu/device.h"
#include "gpu/pipeline.h"
#include "shading/tables.h"
#include "shading_gpu/agreement_case.h"
#include "test_shading_gpu_shaders.h"

namespace heliodon::shading {
namespace {

constexpr uint cases = 4096;

Result<std::vector<vec4>> values_from_the_device() {
    auto instance = gpu::Instance::create();
    if (!instance) return tl::unexpected(instance.error());
    auto device = gpu::Device::create(*instance);
    if (!device) return tl::unexpected(device.error());
    gpu::ShaderLibrary library(tests::embedded_shaders());
    auto shader = library.find("shading_gpu/agreement.comp");
    if (!shader) return tl::unexpected(shader.error());
    auto pipeline = gpu::ComputePipeline::create(**device, *shader, {{9, 1}});  // shading_extended
    if (!pipeline) return tl::unexpected(pipeline.error());

    const std::span<const float> tables = shading_tables();
    auto table_buffer = gpu::Buffer::create(**device, {"tables", tables.size_bytes()});
    if (!table_buffer) return tl::unexpected(table_buffer.error());
    auto values = gpu::Buffer::create(**device, {"values", cases * agreement_values * sizeof(vec4)});
    if (!values) return tl::unexpected(values.error());
    if (auto uploaded = (*device)->upload(*table_buffer, tables); !uploaded) return tl::unexpected(uploaded.error());
    auto run = (*device)->run("agreement", [&](gpu::Commands& commands) {
        commands.dispatch_threads(*pipeline, gpu::NoPushConstants{}, {*table_buffer, *values},
                                  {cases * agreement_values, 1, 1});
    });
    if (!run) return tl::unexpected(run.error());
    return (*device)->read_back_as<vec4>(*values);
}

TEST(Agreement, EveryFormulaGivesTheSameInBothLanguages) {
    const auto device_values = values_from_the_device();
    ASSERT_TRUE(device_values) << device_values.error().text();
    ASSERT_EQ(device_values->size(), cases * agreement_values);
    std::vector<double> worst(agreement_values, 0.0);
    std::vector<uint> worst_case(agreement_values, 0);
    for (uint i = 0; i < cases; ++i) {
        for (uint k = 0; k < agreement_values; ++k) {
            const vec4 here = agreement_value(i, k), there = (*device_values)[i * agreement_values + k];
            const float size = std::max(1.0f, std::max(std::max(std::abs(here.x), std::abs(here.y)),
                                                       std::max(std::abs(here.z), std::abs(here.w))));
            for (int c = 0; c < 4; ++c) {
                ASSERT_TRUE(std::isfinite(here[c]) && std::isfinite(there[c])) << "case " << i << " value " << k;
                const double error = std::abs(here[c] - there[c]) / size;
                if (error > worst[k]) {
                    worst[k] = error;
                    worst_case[k] = i;
                }
            }
        }
    }
    for (uint k = 0; k < agreement_values; ++k) {
        // The angle from the sun is an arc sine, of which Vulkan asks 4096 units in the last place; skies fall steeply with it.
        EXPECT_LT(worst[k], k == agreement_sky_value ? 1e-3 : 1e-4) << "value " << k << ", case " << worst_case[k];
        RecordProperty("worst_" + std::to_string(k), std::to_string(worst[k]));
    }
}

}  // namespace
}  // namespace heliodon::shading
