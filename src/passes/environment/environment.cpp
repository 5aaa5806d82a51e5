#include "passes/environment/environment.h"

#include <algorithm>
#include <bit>

#include "gpu/commands.h"
#include "passes/environment/environment_shared.h"

namespace heliodon::passes {
namespace {

constexpr std::uint32_t widest_specular_map = 1024;
constexpr std::uint32_t narrowest_specular_map = 32;
constexpr std::uint32_t irradiance_width = 64, reflected_width = 32;
constexpr std::uint32_t sky_picture_width = 512;

/// Leaves an image that has that size already; says whether it did not.
Result<bool> reserve_map(gpu::Device& device, gpu::Image& image, const char* name, std::uint32_t width, std::uint32_t mips) {
    if (image.handle() != VK_NULL_HANDLE && image.extent().width == width && image.mips() == mips) return false;
    gpu::ImageDescription description;
    description.name = name;
    description.format = VK_FORMAT_R32G32B32A32_SFLOAT;
    description.extent = {width, std::max(1u, width / 2), 1};
    description.mips = mips;
    description.usage = VK_IMAGE_USAGE_STORAGE_BIT;
    auto made = gpu::Image::create(device, description);
    if (!made) return tl::unexpected(made.error());
    image = std::move(*made);
    return true;
}

const gpu::Access storage{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, VK_IMAGE_LAYOUT_GENERAL};
const gpu::Access sampled{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
                          VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};

/// One step: writes `image`, which later steps and passes sample.
template <class Record>
void write_map(gpu::Commands& commands, gpu::Timestamps& timestamps, const gpu::Image& image, const char* name, Record&& record) {
    commands.transition(image, storage);
    const std::uint32_t scope = timestamps.begin(commands, name);
    record();
    timestamps.end(commands, scope);
    commands.transition(image, sampled);
}

/// The picture of a sky that is a formula, and what the sky shows to glossy surfaces.
Result<void> record_radiance(gpu::Commands& commands, gpu::Pipelines& pipelines, const EnvironmentMaps& maps, const EnvironmentWork& work,
                             gpu::Timestamps& timestamps) {
    auto picture = pipelines.compute("passes/environment/sky_picture.comp");
    if (!picture) return tl::unexpected(picture.error());
    auto specular = pipelines.compute("passes/environment/specular.comp");
    if (!specular) return tl::unexpected(specular.error());
    if (!work.image)
        write_map(commands, timestamps, maps.picture, "sky picture", [&] {
            for (std::uint32_t level = 0; level < maps.picture.mips(); ++level) {
                const VkExtent3D extent = maps.picture.extent(level);
                commands.dispatch_threads(**picture, shading::SkyPictureConstants{extent.width, extent.height},
                                          {maps.picture.mip(level), maps.record}, {extent.width, extent.height, 1});
            }
        });
    const gpu::Image& sky = work.image ? *work.image : maps.picture;
    write_map(commands, timestamps, maps.specular, "sky specular", [&] {
        const std::uint32_t count = maps.specular.mips();
        for (std::uint32_t level = 0; level < count; ++level) {
            const VkExtent3D extent = maps.specular.extent(level);
            const float roughness = static_cast<float>(level) / static_cast<float>(count - 1);
            commands.dispatch_threads(**specular, shading::EnvironmentConstants{extent.width, extent.height, roughness, 0},
                                      {maps.specular.mip(level), gpu::Binding(sky, work.sampler)}, {extent.width, extent.height, 1});
        }
    });
    return {};
}

}  // namespace

Result<bool> reserve_environment(gpu::Device& device, EnvironmentMaps& maps, std::uint32_t width) {
    const bool formula = width == 0;
    if (formula) width = sky_picture_width;
    if (!formula) maps.picture = {};
    if (maps.record.handle() == VK_NULL_HANDLE) {
        auto made = gpu::Buffer::create(device, {"sky record", sizeof(shading::SkyData)});
        if (!made) return tl::unexpected(made.error());
        maps.record = std::move(*made);
    }
    const std::uint32_t base = std::clamp(std::bit_floor(std::max(width, 1u)), narrowest_specular_map, widest_specular_map);
    // One level could hold no roughness but 0: two at least.
    const auto levels = std::max(2u, static_cast<std::uint32_t>(std::bit_width(base / narrowest_specular_map)));
    bool any = false;
    const auto reserve = [&](gpu::Image& image, const char* name, std::uint32_t map_width, std::uint32_t mips) -> Result<void> {
        auto made = reserve_map(device, image, name, map_width, mips);
        if (!made) return tl::unexpected(made.error());
        any = any || *made;
        return {};
    };
    Result<void> done;
    if (formula) done = reserve(maps.picture, "sky picture", sky_picture_width, std::bit_width(sky_picture_width) - 1);
    done = done.and_then([&] { return reserve(maps.specular, "sky specular", base, levels); })
               .and_then([&] { return reserve(maps.irradiance, "sky irradiance", irradiance_width, 1); })
               .and_then([&] { return reserve(maps.reflected, "sky reflected", reflected_width, 1); });
    if (!done) return tl::unexpected(done.error());
    return any;
}

Result<void> record_environment(gpu::Commands& commands, gpu::Pipelines& pipelines, const EnvironmentMaps& maps,
                                const EnvironmentWork& work, gpu::Timestamps& timestamps) {
    auto irradiance = pipelines.compute("passes/environment/irradiance.comp");
    if (!irradiance) return tl::unexpected(irradiance.error());
    const auto add_up = [&](const gpu::Image& image, const char* name, const gpu::Image& source, bool even) {
        write_map(commands, timestamps, image, name, [&] {
            const VkExtent3D extent = image.extent();
            commands.dispatch(**irradiance, shading::EnvironmentConstants{extent.width, extent.height, 1.0f, even ? 1u : 0u},
                              {image, gpu::Binding(source, work.sampler)}, {extent.width, extent.height, 1});
        });
    };
    if (work.sky) {
        if (auto done = record_radiance(commands, pipelines, maps, work, timestamps); !done) return done;
        add_up(maps.irradiance, "sky irradiance", work.image ? *work.image : maps.picture, false);
    }
    if (work.reflected) add_up(maps.reflected, "sky reflected", maps.irradiance, work.even);
    return {};
}

}  // namespace heliodon::passes
