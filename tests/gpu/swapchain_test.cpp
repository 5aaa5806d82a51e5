#include "gpu/swapchain.h"

#include "gpu_test.h"

namespace heliodon::gpu {
namespace {

/// Presents to a surface without a window (VK_EXT_headless_surface), which Mesa's drivers have.
class Window : public testing::Test {
protected:
    void SetUp() override {
        InstanceSettings settings;
        settings.validation = true;
        settings.extensions = {VK_KHR_SURFACE_EXTENSION_NAME, VK_EXT_HEADLESS_SURFACE_EXTENSION_NAME};
        auto instance = Instance::create(settings);
        if (!instance) GTEST_SKIP() << instance.error().text();
        DeviceSettings device_settings;
        device_settings.swapchain = true;
        device_settings.pipeline_cache_directory = "";
        auto opened = Device::create(*instance, device_settings);
        if (!opened) GTEST_SKIP() << opened.error().text();
        device = std::move(*opened);
        const VkHeadlessSurfaceCreateInfoEXT info{VK_STRUCTURE_TYPE_HEADLESS_SURFACE_CREATE_INFO_EXT};
        const auto create = reinterpret_cast<PFN_vkCreateHeadlessSurfaceEXT>(
            vkGetInstanceProcAddr((*instance)->handle(), "vkCreateHeadlessSurfaceEXT"));
        ASSERT_EQ(create((*instance)->handle(), &info, nullptr, &surface), VK_SUCCESS);
    }
    void TearDown() override {
        if (!device) return;
        const auto destroy = reinterpret_cast<PFN_vkDestroySurfaceKHR>(
            vkGetInstanceProcAddr(device->instance().handle(), "vkDestroySurfaceKHR"));
        expect_ok(device->wait_idle());
        destroy(device->instance().handle(), surface, nullptr);
        for (const auto& message : device->validation_messages()) ADD_FAILURE() << message;
    }
    bool show(Swapchain& swapchain, float red) {
        const auto frame = value_of(swapchain.acquire());
        if (!frame) return false;
        auto commands = value_of(device->begin_commands("frame"));
        commands.transition(*frame->image, {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                            VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL});
        commands.clear({frame->image}, {{red, 0, 0, 1}});
        commands.transition(*frame->image,
                            {VK_PIPELINE_STAGE_2_NONE, VK_ACCESS_2_NONE, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR});
        value_of(device->submit(std::move(commands), {.wait = frame->acquired, .signal = frame->finished}));
        return value_of(swapchain.present(*frame));
    }

    std::unique_ptr<Device> device;
    VkSurfaceKHR surface = VK_NULL_HANDLE;
};

TEST_F(Window, ShowsManyFramesAndIsResized) {
    for (const bool vsync : {true, false}) {
        Swapchain swapchain = value_of(Swapchain::create(*device, surface, {320, 200}, vsync));
        EXPECT_EQ(swapchain.extent().width, 320u);
        for (int frame = 0; frame < 10; ++frame) EXPECT_TRUE(show(swapchain, 0.1f * static_cast<float>(frame)));
        expect_ok(swapchain.resize({640, 400}));
        EXPECT_EQ(swapchain.extent().width, 640u);
        for (int frame = 0; frame < 5; ++frame) EXPECT_TRUE(show(swapchain, 1.0f));
    }
}

TEST_F(Window, NeedsADeviceMadeForPresenting) {
    DeviceSettings settings;
    settings.pipeline_cache_directory = "";
    const auto plain = value_of(Device::create(value_of(Instance::create()), settings));
    const auto swapchain = Swapchain::create(*plain, surface, {320, 200});
    ASSERT_FALSE(swapchain);
    EXPECT_EQ(swapchain.error().text(), "window: the device was not created for presenting");
}

}  // namespace
}  // namespace heliodon::gpu
