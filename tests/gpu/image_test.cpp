#include <algorithm>

#include "gpu_test.h"

namespace heliodon::gpu {
namespace {

class Images : public GpuTest {
protected:
    static constexpr Access sampled{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
                                    VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    static constexpr Access storage{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                                    VK_IMAGE_LAYOUT_GENERAL};
    static constexpr Access color{VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                                  VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT,
                                  VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};

    [[nodiscard]] static Image image(ImageDescription description) {
        description.format = VK_FORMAT_R32G32B32A32_SFLOAT;
        return value_of(Image::create(device(), description));
    }
    static void fill(const Image& image, glm::vec4 value, std::uint32_t mip, std::uint32_t layer) {
        const VkExtent3D extent = image.extent(mip);
        const std::vector<glm::vec4> texels(extent.width * extent.height * extent.depth, value);
        expect_ok(device().upload(image, std::as_bytes(std::span(texels)), mip, layer));
    }
    [[nodiscard]] static glm::vec4 at(const std::vector<glm::vec4>& pixels, int width, int x, int y) {
        return pixels[static_cast<std::size_t>(y) * width + x];
    }
};

TEST_F(Images, AreWrittenMipByMip) {
    const Image target = image({.name = "mips", .extent = {16, 8, 1}, .mips = 5, .usage = VK_IMAGE_USAGE_STORAGE_BIT});
    expect_ok(device().run("write mips", [&](Commands& commands) {
        commands.transition(target, storage);
        for (std::uint32_t mip = 0; mip < target.mips(); ++mip) {
            const VkExtent3D extent = target.extent(mip);
            commands.dispatch_threads(compute("write_mip.comp"), glm::vec4(static_cast<float>(mip)), {target.mip(mip)},
                                      {extent.width, extent.height, 1});
        }
    }));
    for (std::uint32_t mip = 0; mip < target.mips(); ++mip) {
        const auto texels = value_of(device().read_back_as<glm::vec4>(target, mip));
        EXPECT_EQ(texels.size(), std::max(1u, 16u >> mip) * std::max(1u, 8u >> mip));
        for (const glm::vec4& texel : texels) ASSERT_EQ(texel, glm::vec4(static_cast<float>(mip)));
    }
}

TEST_F(Images, OfEveryShapeAreSampled) {
    const Image flat = image({.name = "flat", .extent = {4, 4, 1}, .mips = 3});
    const Image cube = image({.name = "cube", .extent = {4, 4, 1}, .layers = 6, .shape = ImageShape::cube});
    const Image volume = image({.name = "volume", .extent = {2, 2, 2}, .shape = ImageShape::volume});
    for (std::uint32_t mip = 0; mip < 3; ++mip) fill(flat, glm::vec4(static_cast<float>(10 + mip)), mip, 0);
    for (std::uint32_t face = 0; face < 6; ++face) fill(cube, glm::vec4(static_cast<float>(20 + face)), 0, face);
    std::vector<glm::vec4> slices(8, glm::vec4(30));
    std::fill(slices.begin() + 4, slices.end(), glm::vec4(31));
    expect_ok(device().upload(volume, std::as_bytes(std::span(slices))));

    const VkSampler sampler = value_of(device().sampler(SamplerDescription::nearest_clamp()));
    EXPECT_EQ(sampler, value_of(device().sampler(SamplerDescription::nearest_clamp()))) << "samplers are shared";
    const Buffer colors = buffer("colors", 5 * 16);
    expect_ok(device().run("sample", [&](Commands& commands) {
        commands.dispatch(compute("sample_image.comp"), NoPushConstants{},
                          {{flat, sampler}, {cube, sampler}, {volume, sampler}, colors}, {1, 1, 1});
    }));
    const auto seen = value_of(device().read_back_as<glm::vec4>(colors));
    EXPECT_EQ(seen[0].x, 10.0f);
    EXPECT_EQ(seen[1].x, 11.0f);
    EXPECT_EQ(seen[2].x, 20.0f) << "+X is face 0";
    EXPECT_EQ(seen[3].x, 25.0f) << "-Z is face 5";
    EXPECT_EQ(seen[4].x, 31.0f);
}

TEST_F(Images, OfImpossibleShapeAreRefusedByName) {
    for (const ImageDescription& wrong :
         {ImageDescription{.name = "wrong", .extent = {0, 4, 1}},
          ImageDescription{.name = "wrong", .extent = {4, 4, 1}, .mips = 4},
          ImageDescription{.name = "wrong", .extent = {1u << 20, 4, 1}},
          ImageDescription{.name = "wrong", .extent = {4, 8, 1}, .layers = 6, .shape = ImageShape::cube},
          ImageDescription{.name = "wrong",
          .format = VK_FORMAT_D32_SFLOAT,
          .extent = {4, 4, 1},
          .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT}}) {
        const auto made = Image::create(device(), wrong);
        ASSERT_FALSE(made);
        EXPECT_NE(made.error().where.find("'wrong'"), std::string::npos) << made.error().text();
    }
}

TEST_F(Images, NeverWrittenAreNotReadBack) {
    const auto read = device().read_back(image({.name = "empty", .extent = {4, 4, 1}}));
    ASSERT_FALSE(read);
    EXPECT_EQ(read.error().text(), "image 'empty', mip 0, layer 0: it was never written");
}

TEST_F(Images, ShowARasterizedTriangleWithItsTopUp) {
    constexpr int size = 64;
    const Image target =
        image({.name = "target", .extent = {size, size, 1}, .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT});
    GraphicsDescription description;
    description.name = "triangle";
    description.vertex = "shaders/triangle.vert";
    description.fragment = "shaders/triangle.frag";
    description.color_formats = {target.format()};
    const GraphicsPipeline& pipeline = *value_of(pipelines->graphics(description));
    // Counter-clockwise with its tip at the top: seen from the front.
    const std::vector<glm::vec4> corners = {{-1, -1, 0, 0}, {1, -1, 0, 0}, {0, 1, 0, 0}};
    const Buffer corner_buffer = buffer("corners", corners.size() * 16);
    expect_ok(device().upload(corner_buffer, std::span<const glm::vec4>(corners)));
    expect_ok(device().run("draw", [&](Commands& commands) {
        commands.transition(target, color);
        commands.begin_rendering({.color = {{.view = {&target}, .clear = {{0, 0, 0, 0}}}}});
        commands.bind(pipeline, 3.0f, {corner_buffer});
        commands.draw(3);
        commands.end_rendering();
    }));
    const auto pixels = value_of(device().read_back_as<glm::vec4>(target));
    EXPECT_EQ(at(pixels, size, 2, 2), glm::vec4(0)) << "beside the tip, at the top";
    EXPECT_EQ(at(pixels, size, 2, size - 2).a, 1.0f) << "in the base, at the bottom";
    EXPECT_GT(at(pixels, size, size / 2, 3).b, 2.5f) << "the tip is blue, scaled by the push constant";
    EXPECT_GT(at(pixels, size, 2, size - 1).r, 2.5f);
    double covered = 0;
    for (const glm::vec4& pixel : pixels) covered += pixel.a;
    EXPECT_NEAR(covered / (size * size), 0.5, 0.01);
}

TEST_F(Images, AreNotDrawnToWithoutAPipeline) {
    const Image target = image({.name = "target", .extent = {4, 4, 1}, .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT});
    const auto done = device().run("draw", [&](Commands& commands) {
        commands.transition(target, color);
        commands.begin_rendering({.color = {{.view = {&target}}}});
        commands.draw(3);
        commands.end_rendering();
    });
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().text(), "draw: no pipeline is bound");
}

}  // namespace
}  // namespace heliodon::gpu
