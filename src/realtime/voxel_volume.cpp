#include "realtime/voxel_volume.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <glm/gtc/packing.hpp>
#include <tuple>
#include <utility>

#include "passes/occupancy/occupancy.h"

namespace heliodon::realtime {
namespace {

// Empty voxels of the widest cascade round the scene, so that walls at its bounds do not lie between two voxels: in the
// middle of one, or, where cascades have voxels of half that size and half again, two thirds or one third into theirs.
float margin_voxels(int cascades) { return cascades > 1 ? 5.0f / 3 : 1.5f; }
// Whole numbers and fractions that single precision tells apart.
constexpr int exact_bits = 24;
// Inner cascades move by so many voxels at a time: the voxels of the next one must hold them in pairs.
constexpr float snap_voxels = 2.0f;

std::uint64_t cube(std::uint64_t n) { return n * n * n; }

/// Bytes of the textures of all faces, with their levels; lobes have two texels where eight of the others are.
std::uint64_t texture_bytes(std::uint64_t size, std::uint64_t cascades, bool lobes) {
    return (8 + 2 + (lobes ? 2 : 0)) * shading::voxel_faces * cascades * cube(size) * 8 / 7;
}

float brightest_emission(const convert::FlatScene& flat) {
    float brightest = 0;
    for (const shading::MaterialData& material : flat.materials())
        brightest = std::max({brightest, material.emission_nits.x, material.emission_nits.y, material.emission_nits.z});
    return brightest;
}

Result<gpu::Buffer> zeroed(gpu::Device& device, const char* name, VkDeviceSize bytes) {
    if (bytes > device.limits().maxStorageBufferRange)
        return fail("render.voxels", fmt::format("the volume needs {} MiB for its {}, the device binds at most {} MiB",
                                                 bytes >> 20, name, device.limits().maxStorageBufferRange >> 20));
    auto buffer = gpu::Buffer::create(device, {name, bytes, VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT});
    if (!buffer) return buffer;
    auto done = device.run("clear voxels", [&](gpu::Commands& commands) { commands.fill(*buffer, 0); });
    if (!done) return tl::unexpected(done.error());
    return buffer;
}

bool same_range(const passes::TriangleRange& a, const passes::TriangleRange& b) {
    return a.first_triangle == b.first_triangle && a.instance == b.instance;
}

constexpr gpu::Access cleared{VK_PIPELINE_STAGE_2_CLEAR_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL};
constexpr gpu::Access sampled{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
                              VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};

}  // namespace

VoxelVolume::VoxelVolume(gpu::Device& device, gpu::Pipelines& pipelines)
    : device_(device), pipelines_(pipelines), steps_(std::make_unique<Steps>(device)) {}

Result<void> VoxelVolume::check_size(const VoxelSettings& settings) const {
    const std::uint64_t n = settings.voxels, c = settings.cascades;
    const std::uint64_t most = device_.limits().maxImageDimension3D;
    if (std::max({2 * n, 3 * n, c * n}) > most)
        return fail("render.voxels", fmt::format("a volume of {} voxels an edge in {} cascades needs a 3D texture of {}x{}x{} "
                                                 "texels, the device has at most {} a side", n, c, 2 * n, c * n, 3 * n, most));
    const std::uint64_t bytes = texture_bytes(n, c, settings.lobes) + 8 * c * cube(n), memory = device_.info().memory_bytes;
    if (memory > 0 && bytes > memory)
        return fail("render.voxels", fmt::format("a volume of {} voxels an edge in {} cascades needs {} MiB, the device has {} MiB",
                                                 n, c, bytes >> 20, memory >> 20));
    return {};
}

Result<void> VoxelVolume::open() {
    for (gpu::Buffer* buffer : {&data_buffer_, &shown_buffer_}) {
        auto made = gpu::Buffer::create(device_, {"volume", sizeof(shading::VolumeData), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT});
        if (!made) return tl::unexpected(made.error());
        *buffer = std::move(*made);
    }
    return make_textures({2, 1, 3}, false);
}

Result<void> VoxelVolume::make_textures(VkExtent3D extent, bool lobes) {
    gpu::SamplerDescription sampler = gpu::SamplerDescription::linear_clamp();
    sampler.mipmap_mode = VK_SAMPLER_MIPMAP_MODE_NEAREST;
    auto trilinear = device_.sampler(sampler);
    if (!trilinear) return tl::unexpected(trilinear.error());
    const auto levels = static_cast<std::uint32_t>(std::bit_width(extent.width / 2));
    const VkExtent3D half = lobes ? VkExtent3D{extent.width / 2, extent.height / 2, extent.depth} : VkExtent3D{1, 1, 1};
    struct Texture {
        gpu::Image& image;
        const char* name;
        VkFormat format;
        VkExtent3D extent;
        std::uint32_t mips;
    };
    const Texture textures[] = {{faces_, "voxel faces", VK_FORMAT_R16G16B16A16_SFLOAT, extent, levels},
                                {depths_, "voxel depths", VK_FORMAT_R16_SFLOAT, extent, levels},
                                {lobes_, "voxel lobes", VK_FORMAT_R16G16B16A16_SFLOAT, half, lobes ? levels - 1 : 1}};
    for (const Texture& texture : textures) texture.image = {};
    for (const Texture& texture : textures) {
        auto made = gpu::Image::create(device_, {.name = texture.name, .format = texture.format, .extent = texture.extent, .mips = texture.mips,
                                                 .shape = gpu::ImageShape::volume, .usage = VK_IMAGE_USAGE_STORAGE_BIT});
        if (!made)
            return fail("render.voxels", fmt::format("a volume of {}x{}x{} texels: {}", extent.width, extent.height, extent.depth,
                                                     made.error().text()));
        texture.image = std::move(*made);
    }
    ++texture_revision_;
    shown_ = {};
    auto occupancy = zeroed(device_, "occupancy", passes::occupancy_bytes(extent.width / 2, extent.height / (extent.width / 2)));
    if (!occupancy) return tl::unexpected(occupancy.error());
    occupancy_ = std::move(*occupancy);
    inputs_ = {&faces_, &depths_, &lobes_, &data_buffer_, &occupancy_, *trilinear, 2 * extent.height > extent.width, lobes};
    shown_inputs_ = inputs_;
    shown_inputs_.data = &shown_buffer_;
    return device_.run("clear volume", [&](gpu::Commands& commands) {
        for (const gpu::Image* image : {&faces_, &depths_, &lobes_}) {
            commands.transition(*image, cleared);
            commands.clear({image}, {});
            commands.transition(*image, sampled);
        }
    });
}

Result<void> VoxelVolume::make_buffers() {
    const auto n = static_cast<std::uint32_t>(settings_.voxels);
    const auto sizes = passes::voxel_buffer_sizes(n, record_capacity_, tile_capacity_);
    const VkDeviceSize face_bytes = 16ull * shading::voxel_faces * record_capacity_;
    cascades_.clear();
    for (int c = 0; c < settings_.cascades; ++c) {
        auto cascade = std::make_unique<Cascade>();
        const auto make = [&](gpu::Buffer& buffer, const char* name, VkDeviceSize bytes) -> Result<void> {
            auto made = zeroed(device_, name, bytes);
            if (!made) return tl::unexpected(made.error());
            buffer = std::move(*made);
            return {};
        };
        const Result<void> done = make(cascade->numbers, "voxel numbers", sizes.numbers)
                                      .and_then([&] { return make(cascade->cells, "voxel cells", sizes.cells); })
                                      .and_then([&] { return make(cascade->records, "voxel records", sizes.records); })
                                      .and_then([&] { return make(cascade->tiles, "voxel tiles", sizes.tiles); })
                                      .and_then([&] { return make(cascade->levels, "voxel levels", sizes.levels); })
                                      .and_then([&] { return make(cascade->shown_numbers, "shown numbers", sizeof(shading::VoxelHeader)); })
                                      .and_then([&] { return make(cascade->shown_cells, "shown cells", sizes.cells); })
                                      .and_then([&] { return make(cascade->shown_levels, "shown levels", sizes.levels); })
                                      .and_then([&] { return make(cascade->lit_faces, "lit faces", passes::lit_faces_bytes(record_capacity_)); })
                                      .and_then([&] { return make(cascade->exitance, "voxel exitance", face_bytes); })
                                      .and_then([&] { return settings_.lobes ? make(cascade->lobes, "voxels' lobes", face_bytes) : Result<void>{}; })
                                      .and_then([&] { return make(cascade->gathered, "gathered light", face_bytes); })
                                      .and_then([&] { return make(cascade->shown_gathered, "shown gathered light", face_bytes); });
        if (!done) return done;
        cascades_.push_back(std::move(cascade));
    }
    return {};
}

Result<void> VoxelVolume::make_still_buffers() {
    const auto sizes = passes::voxel_buffer_sizes(data_.size, record_capacity_, tile_capacity_);
    for (auto& cascade : cascades_)
        for (const auto& [buffer, name, bytes] : {std::tuple{&cascade->still_numbers, "still numbers", VkDeviceSize{sizeof(shading::VoxelHeader)}},
                                                  std::tuple{&cascade->still_cells, "still cells", sizes.cells},
                                                  std::tuple{&cascade->still_records, "still records", sizes.records}}) {
            auto made = zeroed(device_, name, bytes);
            if (!made) return tl::unexpected(made.error());
            *buffer = std::move(*made);
        }
    return {};
}

VoxelVolume::Surfaces VoxelVolume::surfaces(int index) const {
    const Cascade& cascade = *cascades_[static_cast<std::size_t>(index)];
    return {cascade.constants.grid, cascade.numbers, cascade.cells, cascade.records};
}

Result<void> VoxelVolume::place(const GpuScene& scene, glm::vec3 eye) {
    const Bounds bounds = scene.bounds();
    const glm::vec3 extent = glm::max(bounds.max - bounds.min, glm::vec3(0));
    const float longest = std::max({extent.x, extent.y, extent.z, 1e-6f});
    const auto size = static_cast<float>(settings_.voxels);
    const int last = settings_.cascades - 1;
    const float margin = margin_voxels(settings_.cascades);
    const float widest_voxel = longest / (size - 2 * margin);
    shading::VolumeData wanted = data_;
    wanted.size = static_cast<std::uint32_t>(settings_.voxels);
    wanted.cascades = static_cast<std::uint32_t>(settings_.cascades);
    wanted.isotropic = settings_.isotropic ? 1 : 0;
    wanted.voxel_m = std::ldexp(widest_voxel, -last);
    wanted.lattice = bounds.min - margin * widest_voxel;
    for (int c = 0; c <= last; ++c) {
        const float voxel_m = std::ldexp(wanted.voxel_m, c);
        const glm::vec3 corner = (eye - wanted.lattice) / voxel_m - 0.5f * size;
        wanted.cascade[c].base = c == last ? glm::ivec3(0) : glm::ivec3(snap_voxels * glm::round(corner / snap_voxels));
    }
    if (std::memcmp(&wanted, &data_, sizeof(data_)) == 0 && placement_revision_ > 0) return {};
    if (wanted.voxel_m != data_.voxel_m || wanted.lattice != data_.lattice) forget_surfaces();
    data_ = wanted;
    ++placement_revision_;
    for (int c = 0; c <= last; ++c) {
        shading::VoxelGrid& grid = cascades_[c]->constants.grid;
        grid.voxel_m = std::ldexp(data_.voxel_m, c);
        grid.origin = data_.lattice;
        grid.base = data_.cascade[c].base;
        grid.size = data_.size;
        // The lattice has size · 2^(last − c) of this cascade's voxels an edge.
        grid.snap = c == last ? 0.0f : std::ldexp(size, last - c - exact_bits);
        cascades_[c]->constants.cascade = static_cast<std::uint32_t>(c);
    }
    return {};
}

Result<void> VoxelVolume::list_triangles(const GpuScene& scene) {
    const convert::FlatScene& flat = scene.flat();
    std::vector<passes::TriangleRange> still, moving;
    std::uint64_t still_triangles = 0, moving_triangles = 0;
    for (std::uint32_t i = 0; i < flat.instances().size(); ++i) {
        const shading::InstanceData& instance = flat.instances()[i];
        if ((instance.flags & shading::instance_flag_visible) == 0) continue;
        const Geometry* geometry = flat.geometries()[instance.geometry];
        if (!geometry || geometry->mesh.indices.empty()) continue;
        const bool moves = !settings_.anew && scene.surfaces().moves(i);
        std::uint64_t& triangles = moves ? moving_triangles : still_triangles;
        (moves ? moving : still).push_back({static_cast<std::uint32_t>(triangles), i});
        triangles += geometry->mesh.indices.size() / 3;
    }
    if (still_triangles + moving_triangles > 0xffffffffull)
        return fail("", fmt::format("{} triangles are more than can be voxelized", still_triangles + moving_triangles));
    const auto write = [&](GrowingBuffer& buffer, std::span<const passes::TriangleRange> ranges) -> Result<void> {
        if (auto done = buffer.reserve(device_, ranges.size_bytes(), 0); !done || ranges.empty()) return done;
        return device_.upload(buffer.buffer(), ranges);
    };
    if (auto done = write(still_ranges_, still); !done) return done;
    if (auto done = write(moving_ranges_, moving); !done) return done;
    for (auto& cascade : cascades_) {
        for (passes::VoxelizeInputs* inputs : {&cascade->still, &cascade->entered}) {
            inputs->triangle_ranges = &still_ranges_.buffer();
            inputs->range_count = static_cast<std::uint32_t>(still.size());
            inputs->triangle_count = static_cast<std::uint32_t>(still_triangles);
        }
        cascade->moving.triangle_ranges = &moving_ranges_.buffer();
        cascade->moving.range_count = static_cast<std::uint32_t>(moving.size());
        cascade->moving.triangle_count = static_cast<std::uint32_t>(moving_triangles);
        cascade->entered.entered_only = true;
    }
    if (!std::equal(still.begin(), still.end(), still_.begin(), still_.end(), same_range) ||
        loaded_revision_ != scene.surfaces().loaded_revision())
        forget_surfaces();
    still_ = std::move(still);
    moving_ = std::move(moving);
    loaded_revision_ = scene.surfaces().loaded_revision();
    // A power of two at least as bright: lamps that are dimmed seldom change it.
    const float brightest = brightest_emission(flat);
    const float unit = brightest > 0 ? std::exp2(std::ceil(std::log2(brightest))) : 1.0f;
    if (unit != emission_unit_) forget_surfaces();
    emission_unit_ = unit;
    emits_ = brightest > 0;
    return {};
}

void VoxelVolume::forget_surfaces() {
    for (auto& cascade : cascades_) cascade->known = false;
}

Result<void> VoxelVolume::prepare(const Source& source, const VoxelSettings& settings, glm::vec3 eye) {
    const bool same_size = settings.voxels == settings_.voxels && settings.cascades == settings_.cascades;
    if (settings.anew != settings_.anew) listed_revision_ = ~0ull;
    settings_.anew = settings.anew;
    if (!(settings == settings_) || remake_) {
        if (auto done = check_size(settings); !done) return done;
        if (auto done = device_.wait_idle(); !done) return done;
        remake_ = true;
        outdated_ = false;
        settings_ = settings;
        if (record_capacity_ == 0 || !same_size) {
            // Four sheets of voxels to begin with, and their tiles; grow() finds what a scene really needs.
            const auto n = static_cast<std::uint32_t>(settings.voxels);
            record_capacity_ = std::max(record_capacity_, 4 * n * n);
            tile_capacity_ = std::max(tile_capacity_, 4 * n * n / (shading::voxel_tile_edge * shading::voxel_tile_edge));
        }
        const auto n = static_cast<std::uint32_t>(settings.voxels), c = static_cast<std::uint32_t>(settings.cascades);
        if (auto done = make_textures({2 * n, c * n, 3 * n}, settings.lobes); !done) return done;
        if (auto done = make_buffers(); !done) return done;
        listed_revision_ = ~0ull;
        ++placement_revision_;
        data_ = {};
    }
    if (listed_revision_ != source.scene.surface_revision()) {
        if (auto done = list_triangles(source.scene); !done) return done;
        listed_revision_ = source.scene.surface_revision();
    }
    if (auto done = place(source.scene, eye); !done) return done;
    if ((cascades_.size() > 1 || !moving_.empty()) && !cascades_.front()->still_records) {
        if (auto done = make_still_buffers(); !done) return done;
        passes_known_ = false;
    }
    for (auto& cascade : cascades_)
        for (passes::VoxelizeInputs* inputs : {&cascade->still, &cascade->entered, &cascade->moving})
            inputs->shading_tables = source.lighting.shading_tables;
    if (remake_ || !passes_known_)
        if (auto done = build_graphs(source); !done) return done;
    remake_ = false;
    return {};
}

Result<void> VoxelVolume::upload_data(shading::VolumeData data) {
    shading::VolumeData all = data_;
    all.radiance_unit = data.radiance_unit;
    all.sky_enabled = data.sky_enabled;
    all.effects = data.effects;
    all.cone_sets = data.cone_sets;
    all.gather_sets = data.gather_sets;
    for (auto& cascade : cascades_) cascade->constants.grid.radiance_unit = data.radiance_unit;
    data_.radiance_unit = data.radiance_unit;
    if (shown_.size == 0) shown_ = data_;
    current_ = all;
    return device_.upload(data_buffer_, std::span<const shading::VolumeData>(&all, 1));
}

Result<void> VoxelVolume::record_surfaces(gpu::Commands& commands, gpu::Timestamps* timestamps, bool keep_light,
                                          graph::Executor* beside) {
    if (settings_.anew) forget_surfaces();
    // What is shown must be what gathered last, of voxels that are still of the same size.
    keeps_light_ = keep_light && !outdated_ && shown_.lattice == data_.lattice && shown_.voxel_m == data_.voxel_m;
    // Where all is voxelized anew, nothing is needed where it was.
    swapped_ = settings_.anew && !outdated_;
    for (auto& cascade : cascades_) {
        if (!swapped_) break;
        std::swap(cascade->cells, cascade->shown_cells);
        std::swap(cascade->levels, cascade->shown_levels);
        if (keeps_light_) std::swap(cascade->gathered, cascade->shown_gathered);
    }
    if (auto done = steps_->keep_shown.execute(commands, timestamps); !done) return done;
    outdated_ = true;
    for (std::size_t cascade = 0; cascade < cascades_.size(); ++cascade)
        if (auto done = record_surfaces(commands, timestamps, cascade, beside); !done) return done;
    return {};
}

Result<void> VoxelVolume::record_surfaces(gpu::Commands& commands, gpu::Timestamps* timestamps, std::size_t index,
                                          graph::Executor* beside) {
    Cascade& cascade = *cascades_[index];
    SurfaceSteps& steps = *steps_->surfaces[index];
    shading::VoxelGrid& grid = cascade.constants.grid;
    grid.emission_unit = emission_unit_;
    for (passes::VoxelizeInputs* inputs : {&cascade.still, &cascade.entered, &cascade.moving}) inputs->grid = grid;
    const glm::ivec3 shift = grid.base - cascade.base;
    cascade.constants.shift = shift;
    const int all_before = work_.all, entered_before = work_.entered;
    const auto keep = [&]() -> Result<void> {
        if (std::exchange(cascade.kept, true)) return {};
        return steps.keep.execute(commands, timestamps);
    };
    if (!cascade.known || glm::any(glm::greaterThanEqual(glm::abs(shift), glm::ivec3(settings_.voxels)))) {
        if (auto done = steps.all.execute(commands, timestamps, beside); !done) return done;
        cascade.known = cascade.in_place = true;
        cascade.kept = false;
        ++work_.all;
    } else if (shift != glm::ivec3(0)) {
        if (auto done = keep(); !done) return done;
        cascade.entered.shift = shift;
        if (auto done = steps.enter.execute(commands, timestamps, beside); !done) return done;
        cascade.in_place = true;
        cascade.kept = false;
        ++work_.entered;
    }
    cascade.base = grid.base;
    if (!moving_.empty() || !cascade.in_place) {
        if (auto done = keep(); !done) return done;
        if (auto done = steps.move.execute(commands, timestamps, beside); !done) return done;
        cascade.in_place = moving_.empty();
        ++work_.moving;
    } else if (work_.all == all_before && work_.entered == entered_before) {
        return {};
    }
    cascade.gathered_known = false;
    return steps.list.execute(commands, timestamps);
}

Result<void> VoxelVolume::show(graph::Executor& step, gpu::Commands& commands, gpu::Timestamps* timestamps) {
    if (auto done = step.execute(commands, timestamps); !done) return done;
    outdated_ = false;
    shown_ = data_;
    return {};
}

void VoxelVolume::set_lights(std::uint32_t light_first, std::uint32_t light_count, bool add) {
    for (auto& cascade : cascades_) {
        cascade->constants.light_first = light_first;
        cascade->constants.light_count = light_count;
        cascade->constants.add = add ? 1 : 0;
    }
}

Result<void> VoxelVolume::record_lights(gpu::Commands& commands, gpu::Timestamps* timestamps, std::uint32_t light_first,
                                        std::uint32_t light_count, bool add) {
    set_lights(light_first, light_count, add);
    return steps_->lights.execute(commands, timestamps);
}

Result<void> VoxelVolume::record_emission(gpu::Commands& commands, gpu::Timestamps* timestamps) {
    return show(steps_->emission, commands, timestamps);
}

Result<void> VoxelVolume::set_gather(const Gather& gather) {
    for (auto& cascade : cascades_) {
        const std::uint32_t every_face = (1u << shading::voxel_faces) - 1;
        cascade->gather_faces.all = gather.side ? 1u << *gather.side : every_face;
        cascade->gather_faces.unlit = cascade->gathered_known ? 0 : every_face & ~cascade->gather_faces.all;
        cascade->gathered_known = true;
        cascade->constants.gather_shift = gather.shift;
        cascade->constants.gather_weight = gather.weight;
        cascade->constants.gather_share = gather.share;
    }
    // Light is gathered from the texture as it is, by the cones of now.
    shading::VolumeData before = current_;
    before.lattice = shown_.lattice;
    before.voxel_m = shown_.voxel_m;
    before.radiance_unit = shown_.radiance_unit;
    std::copy(std::begin(shown_.cascade), std::end(shown_.cascade), std::begin(before.cascade));
    return device_.upload(shown_buffer_, std::span<const shading::VolumeData>(&before, 1));
}

Result<void> VoxelVolume::record_bounce(gpu::Commands& commands, gpu::Timestamps* timestamps,
                                        const std::optional<Gather>& gather) {
    if (!gather) {
        for (auto& cascade : cascades_) cascade->gathered_known = true;
        return show(steps_->reflect, commands, timestamps);
    }
    if (auto done = set_gather(*gather); !done) return done;
    return show(steps_->bounce, commands, timestamps);
}

Result<void> VoxelVolume::record_lit_bounce(gpu::Commands& commands, gpu::Timestamps* timestamps, std::uint32_t light_first,
                                            std::uint32_t light_count, const Gather& gather) {
    set_lights(light_first, light_count, false);
    if (auto done = set_gather(gather); !done) return done;
    return show(steps_->lit_bounce, commands, timestamps);
}

Result<bool> VoxelVolume::grow() {
    std::uint32_t records = 0, tiles = 0;
    for (const auto& cascade : cascades_) {
        auto bytes = device_.read_back(cascade->numbers, 0, sizeof(shading::VoxelHeader));
        if (!bytes) return tl::unexpected(bytes.error());
        shading::VoxelHeader header;
        std::memcpy(&header, bytes->data(), sizeof(header));
        records = std::max(records, header.record_demand + header.carried_without_room);
        tiles = std::max({tiles, header.tile_demand, header.carried_tile_demand});
    }
    if (records <= record_capacity_ && tiles <= tile_capacity_) return false;
    // An eighth more than now, so that what moves a little finds room too.
    if (records > record_capacity_) record_capacity_ = records + records / 8;
    if (tiles > tile_capacity_) tile_capacity_ = tiles + tiles / 8;
    remake_ = true;
    return true;
}

Result<double> VoxelVolume::total_radiance() const {
    const std::uint32_t level = faces_.mips() - 1;  // one texel a face and cascade
    auto texels = device_.read_back_as<std::uint16_t>(faces_, level);
    if (!texels) return tl::unexpected(texels.error());
    double sum = 0;
    for (std::size_t i = 0; i < texels->size(); ++i)
        if (i % 4 != 3) sum += glm::unpackHalf1x16((*texels)[i]);
    return sum;
}

}  // namespace heliodon::realtime
