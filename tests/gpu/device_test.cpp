#include <filesystem>
#include <fstream>

#include "gpu/pipeline_cache.h"
#include "gpu_test.h"

namespace heliodon::gpu {
namespace {

TEST(Devices, AreListedWithWhatTheyLack) {
    const auto devices = value_of(list_devices());
    ASSERT_FALSE(devices.empty()) << "the tests need a Vulkan driver (Mesa's lavapipe will do)";
    for (const DeviceInfo& device : devices) {
        EXPECT_FALSE(device.name.empty());
        EXPECT_FALSE(device.driver.empty());
        EXPECT_EQ(device.usable, device.missing.empty()) << device.missing;
        EXPECT_GT(device.memory_bytes, 0u);
    }
}

TEST(Devices, AreChosenByNumberOrPartOfTheirName) {
    const auto instance = value_of(Instance::create());
    const DeviceInfo best = value_of(instance->choose(""));
    EXPECT_TRUE(best.usable);
    EXPECT_EQ(value_of(instance->choose(std::to_string(best.number))).name, best.name);
    EXPECT_EQ(value_of(instance->choose(best.name.substr(1, 4))).name, best.name);
    const auto none = instance->choose("no such device");
    ASSERT_FALSE(none);
    EXPECT_NE(none.error().message.find(best.name), std::string::npos) << none.error().message;
}

TEST(Devices, AreNotOpenedForAMissingInstanceExtension) {
    InstanceSettings settings;
    settings.extensions = {"VK_KHR_no_such_extension"};
    const auto instance = Instance::create(settings);
    ASSERT_FALSE(instance);
    EXPECT_NE(instance.error().message.find("VK_KHR_no_such_extension"), std::string::npos);
}

TEST(Validation, ReportsASynchronizationHazard) {
    InstanceSettings settings;
    settings.validation = true;
    const auto instance = value_of(Instance::create(settings));
    DeviceSettings device_settings;
    device_settings.pipeline_cache_directory = "";
    const auto device = value_of(Device::create(instance, device_settings));
    const Buffer target = value_of(Buffer::create(*device, {"target", 64, 0, BufferMemory::device}));
    ASSERT_TRUE(device->validation_messages().empty());
    expect_ok(device->run("two writes without a barrier", [&](Commands& commands) {
        commands.fill(target, 1);
        commands.fill(target, 2);
    }));
    const auto messages = device->validation_messages();
    ASSERT_FALSE(messages.empty());
    EXPECT_NE(messages[0].find("SYNC-HAZARD-WRITE-AFTER-WRITE"), std::string::npos) << messages[0];
    EXPECT_NE(messages[0].find("target"), std::string::npos) << "objects have their names: " << messages[0];
}

class PipelineCacheTest : public testing::Test {
protected:
    PipelineCacheTest() : directory(std::filesystem::path(testing::TempDir()) / "heliodon_pipeline_cache") {
        std::filesystem::remove_all(directory);
    }
    ~PipelineCacheTest() override { std::filesystem::remove_all(directory); }

    /// Opens a device, builds a pipeline, closes it, and says what the cache had taken over from its file.
    std::size_t session(const std::filesystem::path& cache_directory) {
        DeviceSettings settings;
        settings.pipeline_cache_directory = cache_directory;
        const auto device = value_of(Device::create(value_of(Instance::create()), settings));
        const PipelineCache probe(*device, cache_directory);
        file = probe.file();
        Pipelines pipelines(*device, ShaderLibrary(tests::embedded_shaders()));
        EXPECT_TRUE(pipelines.compute("shaders/multiply_add.comp"));
        return probe.loaded_bytes();
    }

    std::filesystem::path directory, file;
};

TEST_F(PipelineCacheTest, IsKeptInAFileAndReadAgain) {
    EXPECT_EQ(session(directory), 0u);
    ASSERT_TRUE(std::filesystem::exists(file));
    EXPECT_GT(session(directory), 0u);
    for (const auto& entry : std::filesystem::directory_iterator(directory)) EXPECT_EQ(entry.path(), file);
}

TEST_F(PipelineCacheTest, IsIgnoredWhenDamaged) {
    session(directory);
    {
        std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
        stream.seekp(100);
        stream.write("damaged", 7);
    }
    EXPECT_EQ(session(directory), 0u);
    std::filesystem::resize_file(file, 40);
    EXPECT_EQ(session(directory), 0u);
    std::ofstream(file, std::ios::binary) << "x";
    EXPECT_EQ(session(directory), 0u);
}

TEST_F(PipelineCacheTest, MayFailToBeWritten) {
    std::ofstream(directory) << "a file where the folder should be";
    EXPECT_EQ(session(directory), 0u);
}

}  // namespace
}  // namespace heliodon::gpu
