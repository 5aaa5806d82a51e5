#pragma once

#include <gtest/gtest.h>

#include "gpu/bindless_textures.h"
#include "gpu/commands.h"
#include "gpu/device.h"
#include "gpu/pipeline.h"
#include "gpu/timestamps.h"
#include "test_gpu_shaders.h"

namespace heliodon::gpu {

/// The value, or a failed test that says the error.
template <class T>
T value_of(Result<T> result) {
    if (!result) throw std::runtime_error(result.error().text());
    return std::move(*result);
}
inline void expect_ok(const Result<void>& result) {
    EXPECT_TRUE(result) << result.error().text();
}

/// A device with validation and synchronization validation; every test ends with no message.
class GpuTest : public testing::Test {
protected:
    static void SetUpTestSuite() {
        InstanceSettings settings;
        settings.validation = true;
        instance_ = value_of(Instance::create(settings));
        DeviceSettings device_settings;
        device_settings.pipeline_cache_directory = "";
        device_ = value_of(Device::create(instance_, device_settings));
    }
    static void TearDownTestSuite() {
        device_.reset();
        if (instance_)
            for (const auto& message : instance_->validation_messages()) ADD_FAILURE() << message;
        instance_.reset();
    }
    void TearDown() override {
        pipelines.reset();
        expect_ok(device().wait_idle());
        for (const auto& message : device().validation_messages()) ADD_FAILURE() << message;
    }

    [[nodiscard]] static Device& device() { return *device_; }
    [[nodiscard]] const ComputePipeline& compute(const std::string& name, const Specialization& specialization = {}) {
        return *value_of(pipelines->compute("shaders/" + name, specialization));
    }
    [[nodiscard]] static Buffer buffer(const std::string& name, VkDeviceSize bytes, VkBufferUsageFlags usage = 0) {
        return value_of(Buffer::create(device(), {name, bytes, usage, BufferMemory::device}));
    }

    std::unique_ptr<Pipelines> pipelines =
        std::make_unique<Pipelines>(*device_, ShaderLibrary(tests::embedded_shaders()));

private:
    static inline std::shared_ptr<Instance> instance_;
    static inline std::unique_ptr<Device> device_;
};

}  // namespace heliodon::gpu
