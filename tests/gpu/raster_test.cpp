#include "gpu_test.h"

namespace heliodon::gpu {
namespace {

/// Draws without attachments; fragments count themselves.
class Rasterization : public GpuTest {
protected:
    static constexpr std::uint32_t size = 64;

    static GraphicsDescription description(const std::string& name) {
        GraphicsDescription description;
        description.name = name;
        description.vertex = "shaders/triangle.vert";
        description.fragment = "shaders/count.frag";
        description.cull_mode = VK_CULL_MODE_NONE;
        return description;
    }
    /// Fragments of the triangle under the diagonal of a square area.
    std::uint32_t fragments(const GraphicsPipeline& pipeline) {
        const std::vector<glm::vec4> corners = {{-1, -1, 0, 0}, {1, -1, 0, 0}, {-1, 1, 0, 0}};
        const Buffer corner_buffer = buffer("corners", corners.size() * 16), count = buffer("count", 4);
        expect_ok(device().upload(corner_buffer, std::span<const glm::vec4>(corners)));
        const std::uint32_t zero = 0;
        expect_ok(device().upload(count, std::span<const std::uint32_t>(&zero, 1)));
        expect_ok(device().run("draw", [&](Commands& commands) {
            Rendering rendering;
            rendering.area = VkRect2D{{0, 0}, {size, size}};
            commands.begin_rendering(rendering);
            commands.bind(pipeline, NoPushConstants{}, {corner_buffer, count});
            commands.draw(3);
            commands.end_rendering();
        }));
        return value_of(device().read_back_as<std::uint32_t>(count))[0];
    }
};

TEST_F(Rasterization, NeedsNoAttachments) {
    const std::uint32_t half = size * size / 2;
    EXPECT_NEAR(fragments(*value_of(pipelines->graphics(description("count")))), half, size);
}

TEST_F(Rasterization, GoesThroughAGeometryShader) {
    if (!device().info().geometry_shader) GTEST_SKIP() << "the device has no geometry shaders";
    GraphicsDescription squares = description("count squares");
    squares.geometry = "shaders/bounding_square.geom";
    EXPECT_EQ(fragments(*value_of(pipelines->graphics(squares))), size * size);
}

TEST_F(Rasterization, IsConservativeWhereTheDeviceCan) {
    GraphicsDescription touched = description("count touched");
    touched.conservative_px = 0.0f;
    const auto pipeline = pipelines->graphics(touched);
    if (!device().info().conservative_rasterization) {
        ASSERT_FALSE(pipeline);
        EXPECT_EQ(pipeline.error().text(), "pipeline 'count touched': needs conservative rasterization of triangles grown by "
                                           "0 pixels, which " + device().info().name + " cannot do");
        return;
    }
    // Every pixel of the diagonal is touched; a device may find its neighbours, too.
    EXPECT_GE(fragments(*value_of(pipeline)), size * (size + 1) / 2);
    EXPECT_LE(fragments(*value_of(pipeline)), size * (size + 1) / 2 + 2 * size);
}

}  // namespace
}  // namespace heliodon::gpu
