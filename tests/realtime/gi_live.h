#pragma once

#include <cstring>
#include <map>

#include "gi_test.h"
#include "realtime/frame_renderer.h"

namespace heliodon::tests {

/// Frames of a window, one after the other, as radiance; under the validation layer.
class LiveFrames : public ::testing::Test {
protected:
    using Renderer = std::unique_ptr<realtime::FrameRenderer>;
    using Records = std::map<std::uint32_t, std::vector<std::uint32_t>>;  // by voxel

    void SetUp() override {
        auto instance = gpu::Instance::create({.validation = true});
        ASSERT_TRUE(instance) << instance.error().text();
        auto created = gpu::Device::create(*instance);
        ASSERT_TRUE(created) << created.error().text();
        device = std::move(*created);
    }
    void TearDown() override {
        if (!device) return;
        for (const std::string& message : device->validation_messages()) ADD_FAILURE() << message;
    }
    Renderer new_renderer() {
        auto made = realtime::FrameRenderer::create(*device, {});
        if (!made) throw std::runtime_error(made.error().text());
        return std::move(*made);
    }
    static void expect(const Result<void>& result) {
        if (!result) throw std::runtime_error(result.error().text());
    }
    /// The next frame; milliseconds of its passes into `times`.
    static std::vector<float> frame(Renderer& renderer, const Scene& scene, const Camera& camera, int size = 32,
                                    realtime::PassTimes* times = nullptr, std::uint32_t aov = shading::frame_aov_none) {
        if (auto updated = renderer->update(scene); !updated) throw std::runtime_error(updated.error().text());
        expect(renderer->resize(size, size, false));
        realtime::FrameSample sample;
        sample.count = 0;
        sample.cone_traced = true;
        sample.aov = aov;
        expect(renderer->render(camera, sample, times));
        auto sum = renderer->read_sum();
        if (!sum) throw std::runtime_error(sum.error().text());
        return std::move(*sum);
    }
    std::vector<float> fresh_frame(const Scene& scene, const Camera& camera, int size = 32) {
        Renderer renderer = new_renderer();
        return frame(renderer, scene, camera, size);
    }
    static double mean(const std::vector<float>& picture) {
        double sum = 0;
        for (std::size_t i = 0; i < picture.size(); ++i) sum += i % 4 == 3 ? 0 : picture[i];
        return sum / (0.75 * static_cast<double>(picture.size()));
    }
    /// The largest difference of two pictures against the mean of the second.
    static double difference(const std::vector<float>& a, const std::vector<float>& b) {
        double largest = 0;
        for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(double{a[i]} - b[i]));
        return largest / mean(b);
    }
    static double volume_light(const Renderer& renderer) {
        auto total = renderer->voxels().total_radiance();
        if (!total) throw std::runtime_error(total.error().text());
        return *total;
    }
    /// What voxels of a cascade hold of surfaces.
    Records records(const Renderer& renderer, int cascade = 0) {
        const auto surfaces = renderer->voxels().surfaces(cascade);
        const auto numbers = device->read_back_as<std::uint32_t>(surfaces.numbers);
        const auto cells = device->read_back_as<std::uint32_t>(surfaces.cells);
        const auto words = device->read_back_as<std::uint32_t>(surfaces.records);
        shading::VoxelHeader header;
        std::memcpy(&header, numbers->data(), sizeof header);
        EXPECT_EQ(header.record_count, header.record_demand);
        constexpr std::size_t count = shading::voxel_faces * shading::voxel_field_count;
        Records result;
        for (std::uint32_t i = 0; i < header.record_count; ++i) {
            EXPECT_EQ((*numbers)[sizeof header / 4 + (*cells)[i]], i + 1);
            result[(*cells)[i]].assign(words->begin() + i * count, words->begin() + (i + 1) * count);
        }
        EXPECT_EQ(result.size(), header.record_count);
        return result;
    }
    static double milliseconds(const realtime::PassTimes& times, std::string_view beginning) {
        double sum = 0;
        for (const PassTime& pass : times.passes)
            if (pass.name.starts_with(beginning)) sum += pass.gpu_ms;
        return sum;
    }

    std::unique_ptr<gpu::Device> device;
};

inline void change_settings(Scene& scene, const std::function<void(RenderSettings&)>& change) {
    RenderSettings settings = scene.render_settings();
    change(settings);
    scene.set_render_settings(settings);
}

}  // namespace heliodon::tests
