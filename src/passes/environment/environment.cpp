#include "passes/environment/environment.h"

#include <algorithm>
#include <bit>

#include "gpu/commands.h"
#include "passes/environment/environment_shared.h"

namespace heliodon::passes {
namespace {

constexpr std::uint32_t widest_specular_map = 1024;
constexpr std::uint32_t narrowest_specular_map = 32;
constexpr std::uint32_t irradiance_width = 64;
constexpr std::uint32_t specular_samples = 512;
constexpr std::uint32_t sky_picture_width = 512;

Result<gpu::Image> map_image(gpu::Device& device, const char* name, std::uint32_t width, std::uint32_t mips) {
    gpu::ImageDescription description;
    description.name = name;
    description.format = VK_FORMAT_R32G32B32A32_SFLOAT;
    description.extent = {width, std::max(1u, width / 2), 1};
    description.mips = mips;
    description.usage = VK_IMAGE_USAGE_STORAGE_BIT;
    return gpu::Image::create(device, description);
}

const gpu::Access storage{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, VK_IMAGE_LAYOUT_GENERAL};
const gpu::Access sampled{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
                          VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};

}  // namespace

Result<gpu::Image> draw_sky(gpu::Device& device, gpu::Pipelines& pipelines, const shading::SkyData& sky) {
    auto pipeline = pipelines.compute("passes/environment/sky_picture.comp");
    if (!pipeline) return tl::unexpected(pipeline.error());
    auto image = map_image(device, "sky picture", sky_picture_width, std::bit_width(sky_picture_width) - 1);
    if (!image) return image;
    auto record = gpu::Buffer::create(device, {"sky record", sizeof sky});
    if (!record) return tl::unexpected(record.error());
    if (auto uploaded = device.upload<shading::SkyData>(*record, std::span(&sky, 1)); !uploaded) return tl::unexpected(uploaded.error());
    auto done = device.run("sky picture", [&](gpu::Commands& commands) {
        commands.transition(*image, storage);
        for (std::uint32_t level = 0; level < image->mips(); ++level) {
            const VkExtent3D extent = image->extent(level);
            commands.dispatch_threads(**pipeline, shading::SkyPictureConstants{extent.width, extent.height},
                                      {image->mip(level), *record}, {extent.width, extent.height, 1});
        }
        commands.transition(*image, sampled);
    });
    if (!done) return tl::unexpected(done.error());
    return image;
}

Result<EnvironmentMaps> prefilter_environment(gpu::Device& device, gpu::Pipelines& pipelines, std::uint32_t source,
                                              std::uint32_t width) {
    auto specular = pipelines.compute("passes/environment/specular.comp");
    if (!specular) return tl::unexpected(specular.error());
    auto irradiance = pipelines.compute("passes/environment/irradiance.comp");
    if (!irradiance) return tl::unexpected(irradiance.error());

    const std::uint32_t base = std::clamp(std::bit_floor(std::max(width, 1u)), narrowest_specular_map, widest_specular_map);
    const std::uint32_t levels = static_cast<std::uint32_t>(std::bit_width(base / narrowest_specular_map));
    EnvironmentMaps maps;
    // One level could hold no roughness but 0: two at least.
    auto specular_image = map_image(device, "sky specular", base, std::max(levels, 2u));
    if (!specular_image) return tl::unexpected(specular_image.error());
    maps.specular = std::move(*specular_image);
    auto irradiance_image = map_image(device, "sky irradiance", irradiance_width, 1);
    if (!irradiance_image) return tl::unexpected(irradiance_image.error());
    maps.irradiance = std::move(*irradiance_image);

    auto done = device.run("environment", [&](gpu::Commands& commands) {
        commands.transition(maps.specular, storage);
        commands.transition(maps.irradiance, storage);
        const std::uint32_t count = maps.specular.mips();
        for (std::uint32_t level = 0; level < count; ++level) {
            const VkExtent3D extent = maps.specular.extent(level);
            const shading::EnvironmentConstants push{source, extent.width, extent.height,
                                                     static_cast<float>(level) / static_cast<float>(count - 1), specular_samples};
            commands.dispatch_threads(**specular, push, {maps.specular.mip(level)}, {extent.width, extent.height, 1});
        }
        const VkExtent3D extent = maps.irradiance.extent();
        const shading::EnvironmentConstants push{source, extent.width, extent.height, 1.0f, 0};
        commands.dispatch_threads(**irradiance, push, {maps.irradiance}, {extent.width, extent.height, 1});
        commands.transition(maps.specular, sampled);
        commands.transition(maps.irradiance, sampled);
    });
    if (!done) return tl::unexpected(done.error());
    return maps;
}

}  // namespace heliodon::passes
