#include "passes/meter/meter.h"

namespace heliodon::passes {

Result<graph::BufferHandle> add_meter(graph::Graph& graph, gpu::Pipelines& pipelines, graph::ImageHandle sum,
                                      const ExposureInputs& inputs, bool metered, VkExtent2D extent) {
    auto meter = pipelines.compute("passes/meter/meter.comp");
    if (!meter) return tl::unexpected(meter.error());
    auto expose = pipelines.compute("passes/meter/expose.comp");
    if (!expose) return tl::unexpected(expose.error());
    const graph::BufferHandle histogram =
        graph.create_persistent_buffer({"luminance histogram", 4 * shading::metering_bins * sizeof(std::uint32_t)});
    const graph::BufferHandle state = graph.create_persistent_buffer({"exposure", sizeof(shading::ExposureState)});
    if (metered)
        graph.add_pass(
            "meter", graph::PassKind::compute,
            [&](graph::PassBuilder& pass) {
                pass.read(sum, graph::Usage::storage_read);
                pass.read_write(histogram, graph::Usage::storage_read_write);
            },
            [sum, histogram, extent, &inputs, meter = *meter](graph::PassContext& context) {
                const shading::MeterConstants push{extent.width, extent.height, inputs.sample_scale, inputs.expose.pattern};
                const std::uint32_t stride = shading::metering_stride(extent.width, extent.height);
                context.commands.dispatch_threads(*meter, push, {context.image(sum), context.buffer(histogram)},
                                                  {(extent.width + stride - 1) / stride, (extent.height + stride - 1) / stride, 1});
            });
    graph.add_pass(
        "expose", graph::PassKind::compute,
        [&](graph::PassBuilder& pass) {
            pass.read_write(histogram, graph::Usage::storage_read_write);
            pass.read_write(state, graph::Usage::storage_read_write);
        },
        [histogram, state, &inputs, expose = *expose](graph::PassContext& context) {
            context.commands.dispatch(*expose, inputs.expose, {context.buffer(histogram), context.buffer(state)}, {1, 1, 1});
        });
    return state;
}

}  // namespace heliodon::passes
