// Adds a pass of its own to a frame graph: custom_pass IN.exr OUT.exr reduces a picture to bands of luminance.
#include <heliodon/heliodon.h>
#include <cstdio>

#include "gpu/device.h"
#include "gpu/pipeline.h"
#include "graph/executor.h"
#include "graph/graph.h"

using namespace heliodon;

namespace {

/// Declares the pass: what it reads and writes is all that the graph needs to order it and to place barriers.
graph::ImageHandle add_bands_pass(graph::Graph& frame, gpu::Pipelines& pipelines, graph::ImageHandle radiance) {
    const VkExtent3D extent = frame.description(radiance).extent;
    const graph::ImageHandle bands =
        frame.create_image({.name = "bands", .format = VK_FORMAT_R32G32B32A32_SFLOAT, .extent = extent});
    frame.add_pass(
        "bands", graph::PassKind::compute,
        [&](graph::PassBuilder& pass) {
            pass.read(radiance, graph::Usage::sampled).write(bands, graph::Usage::storage_write);
        },
        [=, &pipelines](graph::PassContext& context) {
            const auto pipeline = pipelines.compute("bands.comp");
            if (!pipeline) return context.commands.fail(pipeline.error().where, pipeline.error().message);
            context.commands.dispatch_threads(**pipeline, gpu::NoPushConstants{},
                                              {context.image(radiance), context.image(bands)},
                                              {extent.width, extent.height, 1});
        });
    return bands;
}

/// Uploads `picture`, runs the graph once and reads the bands back.
Result<Picture> run(const Picture& picture) {
    auto instance = gpu::Instance::create();
    if (!instance) return tl::unexpected(instance.error());
    auto device = gpu::Device::create(*instance);
    if (!device) return tl::unexpected(device.error());
    gpu::Pipelines pipelines(**device, gpu::ShaderLibrary({}, SHADER_DIRECTORY));

    const auto width = static_cast<std::uint32_t>(picture.image.width);
    const auto height = static_cast<std::uint32_t>(picture.image.height);
    const gpu::ImageDescription description{
        .name = "radiance", .format = VK_FORMAT_R32G32B32A32_SFLOAT, .extent = {width, height, 1}};
    auto radiance = gpu::Image::create(**device, description);
    if (!radiance) return tl::unexpected(radiance.error());
    std::vector<glm::vec4> texels;
    for (int y = 0; y < picture.image.height; ++y)
        for (int x = 0; x < picture.image.width; ++x) texels.emplace_back(picture.image.rgb(x, y), 1.0f);
    if (auto sent = (*device)->upload(*radiance, std::as_bytes(std::span(texels))); !sent)
        return tl::unexpected(sent.error());

    graph::Graph frame;
    const graph::ImageHandle input = frame.import_image(description);
    const graph::ImageHandle bands = add_bands_pass(frame, pipelines, input);
    frame.export_image(bands);

    graph::Executor executor(**device);
    if (auto set = executor.set_graph(frame); !set) return tl::unexpected(set.error());
    executor.bind(input, *radiance);
    Result<void> executed;
    auto submitted = (*device)->run("frame", [&](gpu::Commands& commands) { executed = executor.execute(commands); });
    if (!executed) return tl::unexpected(executed.error());
    if (!submitted) return tl::unexpected(submitted.error());

    const auto result = (*device)->read_back_as<float>(executor.image(bands));
    if (!result) return tl::unexpected(result.error());
    Picture output = picture;
    output.layers.clear();
    output.image = Image(picture.image.width, picture.image.height, 4);
    output.image.pixels = *result;
    return output;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3) {
        std::fprintf(stderr, "usage: custom_pass IN.exr OUT.exr\n");
        return 2;
    }
    const auto written = read_picture(argv[1]).and_then(run).and_then(
        [&](const Picture& picture) { return write_picture(argv[2], picture); });
    if (!written) {
        std::fprintf(stderr, "%s\n", written.error().text().c_str());
        return 1;
    }
}
