#include "realtime/gpu_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <numeric>

#include "convert/closed_mesh.h"
#include "gpu/bindless_textures.h"
#include "realtime/scene_features.h"
#include "realtime/vertex_packing.h"

namespace heliodon::realtime {
namespace {

using shading::GeometryData;
using shading::MaterialData;
using shading::TextureRef;

/// The sky record of scene_tables.glsl: the sky and where its prefiltered maps are.
struct SkyRecord {
    shading::SkyData sky;
    std::uint32_t image_slot = shading::no_texture;
    std::uint32_t specular_slot = shading::no_texture;
    std::uint32_t irradiance_slot = shading::no_texture;
    std::uint32_t specular_levels = 1;
    shading::AmbientData ambient{};  // and its lights
};

constexpr std::uint64_t smallest_buffer_bytes = 4096;

std::vector<std::uint32_t> all_of(std::size_t count) {
    std::vector<std::uint32_t> indices(count);
    std::iota(indices.begin(), indices.end(), 0u);
    return indices;
}

/// Uploads the elements of `table` that `changed` (ascending) names, neighbours together.
template <class T>
Result<void> upload_elements(gpu::Device& device, GrowingBuffer& buffer, std::span<const T> table,
                             const std::vector<std::uint32_t>& changed) {
    if (changed.empty()) return {};
    if (auto reserved = buffer.reserve(device, table.size_bytes(), buffer.size()); !reserved) return reserved;
    for (std::size_t i = 0; i < changed.size();) {
        std::size_t end = i + 1;
        while (end < changed.size() && changed[end] == changed[end - 1] + 1) ++end;
        const auto run = table.subspan(changed[i], end - i);
        if (auto done = device.upload(buffer.buffer(), run, changed[i] * sizeof(T)); !done) return done;
        i = end;
    }
    return {};
}

VkFormat format_of(TextureFormat format) {
    switch (format) {
        case TextureFormat::srgb8: return VK_FORMAT_R8G8B8A8_SRGB;
        case TextureFormat::linear8: return VK_FORMAT_R8G8B8A8_UNORM;
        case TextureFormat::float32: return VK_FORMAT_R32G32B32A32_SFLOAT;
    }
    return VK_FORMAT_UNDEFINED;
}
VkSamplerAddressMode address_of(Wrap wrap) {
    switch (wrap) {
        case Wrap::repeat: return VK_SAMPLER_ADDRESS_MODE_REPEAT;
        case Wrap::mirrored_repeat: return VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT;
        case Wrap::clamp_to_edge: return VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    }
    return VK_SAMPLER_ADDRESS_MODE_REPEAT;
}

gpu::SamplerDescription sampler_of(const Texture& texture) {
    const bool nearest = texture.magnify == Filter::nearest && texture.minify == Filter::nearest;
    gpu::SamplerDescription sampler;
    sampler.filter = nearest ? VK_FILTER_NEAREST : VK_FILTER_LINEAR;
    sampler.mipmap_mode = nearest ? VK_SAMPLER_MIPMAP_MODE_NEAREST : VK_SAMPLER_MIPMAP_MODE_LINEAR;
    sampler.address_u = address_of(texture.wrap_u);
    sampler.address_v = address_of(texture.wrap_v);
    sampler.max_anisotropy = nearest ? 1.0f : 8.0f;
    return sampler;
}

/// 32-bit words that a mesh's attributes take in the vertex buffer.
std::uint64_t attribute_words(const Mesh& mesh, bool compact) {
    std::uint64_t words = 3 * mesh.positions.size() + 4 * mesh.colors.size();
    words += (compact ? 1 : 3) * mesh.normals.size() + (compact ? 1 : 4) * mesh.tangents.size();
    for (const auto& set : mesh.texcoords) words += compact && packs_texcoords(set) ? 4 + set.size() : 2 * set.size();
    return words;
}

}  // namespace

Result<void> GrowingBuffer::reserve(gpu::Device& device, std::uint64_t bytes, std::uint64_t used) {
    bytes = std::max(bytes, smallest_buffer_bytes);
    if (bytes <= buffer_.size()) return {};
    const std::uint64_t limit = device.limits().maxStorageBufferRange;
    if (bytes > limit)
        return fail(name_, fmt::format("the scene needs {} MiB here, the device binds at most {} MiB", bytes >> 20,
                                       limit >> 20));
    // Growing by half again keeps the copies of a scene that is built piece by piece linear in its size.
    if (buffer_) bytes = std::min(std::max(bytes, buffer_.size() + buffer_.size() / 2), limit);
    auto larger = gpu::Buffer::create(device, {name_, bytes, usage_});
    if (!larger) return tl::unexpected(larger.error());
    if (buffer_ && used > 0) {
        const std::uint64_t kept = std::min<std::uint64_t>(used, buffer_.size());
        auto copied = device.run("grow " + name_, [&](gpu::Commands& commands) {
            const gpu::Access all{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                  VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT};
            commands.memory_barrier(all, all);
            commands.copy(buffer_, *larger, kept);
            commands.memory_barrier(all, all);
        });
        if (!copied) return copied;
    }
    buffer_ = std::move(*larger);
    return {};
}

GpuScene::GpuScene(gpu::Device& device)
    : device_(device),
      vertices_("vertices", 0),
      indices_("indices", VK_BUFFER_USAGE_INDEX_BUFFER_BIT),
      geometries_("geometries", 0),
      instances_("instances", 0),
      materials_("materials", 0),
      lights_("lights", 0),
      active_lights_("active lights", 0),
      sky_("sky", 0),
      luminaires_("luminaires", 0) {}

GpuScene::~GpuScene() {
    for (auto& texture : textures_)
        if (texture) device_.textures().remove(texture->slot);
}

std::uint32_t GpuScene::slot_of(std::uint32_t texture) const {
    return texture < textures_.size() && textures_[texture] ? textures_[texture]->slot : shading::no_texture;
}

const gpu::Image* GpuScene::sky_image() const {
    const std::uint32_t texture = flat_.sky().texture_index;
    if (flat_.sky().model != shading::sky_model_image || slot_of(texture) == shading::no_texture) return nullptr;
    return &textures_[texture]->image;
}

void GpuScene::release_geometry(std::uint32_t index) {
    if (index >= allocations_.size()) return;
    Allocation& allocation = allocations_[index];
    vertex_ranges_.release(allocation.attributes.start, allocation.attributes.size);
    index_ranges_.release(allocation.indices.start, allocation.indices.size);
    allocation = {};
    geometry_table_[index] = GeometryData{};
}

Result<void> GpuScene::reserve_for(const std::vector<std::uint32_t>& changed) {
    std::uint64_t words = 0, index_count = 0;
    for (const std::uint32_t index : changed) {
        const Geometry* geometry = flat_.geometries()[index];
        if (!geometry) continue;
        words += attribute_words(geometry->mesh, compact_);
        index_count += geometry->mesh.indices.size();
    }
    const auto grow = [&](GrowingBuffer& buffer, RangeAllocator& ranges, std::uint64_t count) -> Result<void> {
        const std::uint64_t free = ranges.capacity() - ranges.used();
        if (free >= count && buffer.size() > 0) return {};
        return grow_ranges(buffer, ranges, count - std::min(count, free));
    };
    if (auto done = grow(vertices_, vertex_ranges_, words); !done) return done;
    return grow(indices_, index_ranges_, index_count);
}

Result<void> GpuScene::grow_ranges(GrowingBuffer& buffer, RangeAllocator& ranges, std::uint64_t count) {
    const std::uint64_t old = ranges.capacity();
    if (auto done = buffer.reserve(device_, (old + count) * 4, old * 4); !done) return done;
    ranges.grow(buffer.size() / 4);
    return {};
}

Result<std::uint64_t> GpuScene::allocate(GrowingBuffer& buffer, RangeAllocator& ranges, std::uint64_t size) {
    if (const auto start = ranges.allocate(size)) return *start;
    // The free space is in pieces: make one at the end.
    if (auto done = grow_ranges(buffer, ranges, size); !done) return tl::unexpected(done.error());
    return *ranges.allocate(size);
}

Result<void> GpuScene::upload_geometry(std::uint32_t index, RealtimeUpdate& update) {
    const Geometry& geometry = *flat_.geometries()[index];
    const Mesh& mesh = geometry.mesh;
    if (mesh.indices.empty() || mesh.positions.empty()) return {};
    Allocation allocation;
    allocation.attributes.size = attribute_words(mesh, compact_);
    allocation.indices.size = mesh.indices.size();
    const auto attributes = allocate(vertices_, vertex_ranges_, allocation.attributes.size);
    if (!attributes) return tl::unexpected(attributes.error());
    allocation.attributes.start = *attributes;
    const auto indices = allocate(indices_, index_ranges_, allocation.indices.size);
    if (!indices) return tl::unexpected(indices.error());
    allocation.indices.start = *indices;
    allocations_[index] = allocation;

    std::uint64_t next = allocation.attributes.start;
    Result<void> status;
    const auto append = [&](const auto& attribute) -> std::uint32_t {
        if (attribute.empty() || !status) return shading::no_attribute;
        const auto bytes = std::as_bytes(std::span(attribute.data(), attribute.size()));
        const std::uint64_t offset = next;
        status = device_.upload(vertices_.buffer(), bytes, offset * 4);
        next += bytes.size() / 4;
        return static_cast<std::uint32_t>(offset);
    };
    GeometryData& data = geometry_table_[index];
    data.bounds_min = geometry.bounds.min;
    data.bounds_max = geometry.bounds.max;
    data.position_offset = append(mesh.positions);
    data.normal_offset = compact_ ? append(pack_normals(mesh.normals)) : append(mesh.normals);
    data.tangent_offset = compact_ ? append(pack_tangents(mesh.tangents)) : append(mesh.tangents);
    data.format = compact_ ? shading::geometry_format_compact_vectors : 0;
    if (convert::is_closed(mesh)) data.format |= shading::geometry_format_closed;
    const auto append_texcoords = [&](const auto& set, std::uint32_t compact_flag) {
        if (!compact_ || !packs_texcoords(set)) return append(set);
        data.format |= compact_flag;
        return append(pack_texcoords(set));
    };
    data.texcoord0_offset = append_texcoords(mesh.texcoords[0], shading::geometry_format_compact_texcoord0);
    data.texcoord1_offset = append_texcoords(mesh.texcoords[1], shading::geometry_format_compact_texcoord1);
    data.color_offset = append(mesh.colors);
    data.first_index = static_cast<std::uint32_t>(allocation.indices.start);
    data.index_count = static_cast<std::uint32_t>(mesh.indices.size());
    if (!status) return status;
    ++update.meshes_uploaded;
    return device_.upload(indices_.buffer(), std::span<const std::uint32_t>(mesh.indices.data(), mesh.indices.size()),
                          allocation.indices.start * 4);
}

Result<void> GpuScene::upload_geometries(const std::vector<std::uint32_t>& changed, RealtimeUpdate& update) {
    const std::size_t count = flat_.geometries().size();
    for (const std::uint32_t index : changed) release_geometry(index);
    allocations_.resize(std::max(count, allocations_.size()));
    geometry_table_.resize(std::max(count, geometry_table_.size()));
    geometry_revisions_.resize(geometry_table_.size());
    for (const std::uint32_t index : changed) ++geometry_revisions_[index];
    if (auto reserved = reserve_for(changed); !reserved) return reserved;
    for (const std::uint32_t index : changed) {
        if (!flat_.geometries()[index]) continue;
        if (auto done = upload_geometry(index, update); !done) return done;
    }
    return upload_elements<GeometryData>(device_, geometries_, geometry_table_, changed);
}

Result<void> GpuScene::upload_texture(std::uint32_t index, RealtimeUpdate& update) {
    const Texture& texture = *flat_.textures()[index];
    const std::uint32_t first = std::min<std::uint32_t>(flat_.texture_first_levels()[index],
                                                        static_cast<std::uint32_t>(texture.levels.size()) - 1);
    const std::uint32_t levels = texture.mipmapped ? static_cast<std::uint32_t>(texture.levels.size()) - first : 1;
    gpu::ImageDescription description;
    description.name = texture.name.empty() ? fmt::format("texture {}", index) : texture.name;
    description.format = format_of(texture.format);
    description.extent = {static_cast<std::uint32_t>(std::max(1, texture.width >> first)),
                          static_cast<std::uint32_t>(std::max(1, texture.height >> first)), 1};
    description.mips = levels;
    auto image = gpu::Image::create(device_, description);
    if (!image) return tl::unexpected(image.error());
    for (std::uint32_t level = 0; level < levels; ++level) {
        const auto& texels = texture.levels[first + level];
        auto done = device_.upload(*image, std::as_bytes(std::span(texels.data(), texels.size())), level);
        if (!done) return done;
    }
    auto sampler = device_.sampler(sampler_of(texture));
    if (!sampler) return tl::unexpected(sampler.error());
    if (textures_[index]) {
        device_.textures().remove(textures_[index]->slot);
        textures_[index].reset();
    }
    LoadedTexture loaded{std::move(*image), shading::no_texture};
    auto slot = device_.textures().add(loaded.image, *sampler);
    if (!slot) return tl::unexpected(slot.error());
    loaded.slot = *slot;
    textures_[index] = std::move(loaded);
    ++update.textures_uploaded;
    return {};
}

Result<bool> GpuScene::upload_textures(const std::vector<std::uint32_t>& changed, RealtimeUpdate& update) {
    textures_.resize(std::max(textures_.size(), flat_.textures().size()));
    for (const std::uint32_t index : changed) {
        const Texture* texture = flat_.textures()[index];
        if (texture && !texture->levels.empty()) {
            if (auto done = upload_texture(index, update); !done) return tl::unexpected(done.error());
        } else if (textures_[index]) {
            device_.textures().remove(textures_[index]->slot);
            textures_[index].reset();
        }
    }
    return !changed.empty();
}

Result<void> GpuScene::upload_materials(const std::vector<std::uint32_t>& changed, RealtimeUpdate& update) {
    // Materials name textures by the scene's index; shaders by bindless slot.
    std::vector<MaterialData> table(flat_.materials().begin(), flat_.materials().end());
    const auto patch = [&](TextureRef& use) { use.texture_index = slot_of(use.texture_index); };
    for (const std::uint32_t index : changed) {
        MaterialData& m = table[index];
        for (TextureRef* use : {&m.base_color_texture, &m.orm_texture, &m.occlusion_texture, &m.normal_texture,
                                &m.bump_texture, &m.emission_texture, &m.transmission_texture, &m.specular_texture,
                                &m.specular_color_texture, &m.clearcoat_texture, &m.clearcoat_roughness_texture,
                                &m.anisotropy_texture, &m.sheen_color_texture, &m.sheen_roughness_texture,
                                &m.iridescence_texture, &m.film_thickness_texture})
            patch(*use);
    }
    update.materials_uploaded += static_cast<int>(changed.size());
    return upload_elements<MaterialData>(device_, materials_, table, changed);
}

Result<void> GpuScene::upload_sky() {
    SkyRecord record;
    record.sky = flat_.sky();
    record.image_slot = sky_maps_.picture != shading::no_texture ? sky_maps_.picture : slot_of(flat_.sky().texture_index);
    record.specular_slot = sky_maps_.specular;
    record.irradiance_slot = sky_maps_.irradiance;
    record.specular_levels = sky_maps_.specular_levels;
    record.ambient = ambient_.data;
    record.ambient.light_count = static_cast<std::uint32_t>(ambient_.lights.size());
    const std::uint64_t lights = std::max<std::uint64_t>(1, ambient_.lights.size()) * sizeof(shading::AmbientLightData);
    if (auto reserved = sky_.reserve(device_, sizeof(record) + lights, 0); !reserved) return reserved;
    if (auto done = device_.upload(sky_.buffer(), std::span<const SkyRecord>(&record, 1)); !done || ambient_.lights.empty()) return done;
    return device_.upload<shading::AmbientLightData>(sky_.buffer(), ambient_.lights, sizeof(record));
}

Result<void> GpuScene::set_ambient(Ambient ambient) {
    ambient_ = std::move(ambient);
    return upload_sky();
}

Result<void> GpuScene::set_sky_maps(const SkyMaps& maps) {
    sky_maps_ = maps;
    return upload_sky();
}

Result<void> GpuScene::set_light_shadows(const std::vector<std::uint32_t>& shadow_of_light,
                                         const std::vector<std::uint32_t>& active_lights) {
    std::vector<shading::LightData> table(flat_.lights().begin(), flat_.lights().end());
    for (std::size_t i = 0; i < table.size(); ++i) table[i].shadow = shadow_of_light[i];
    std::vector<std::uint32_t> changed;
    for (std::uint32_t i = 0; i < table.size(); ++i)
        if (i >= light_shadows_.size() || light_shadows_[i] != shadow_of_light[i]) changed.push_back(i);
    light_shadows_ = shadow_of_light;
    if (auto done = upload_elements<shading::LightData>(device_, lights_, table, changed); !done) return done;
    return upload_elements<std::uint32_t>(device_, active_lights_, active_lights, all_of(active_lights.size()));
}

Result<void> GpuScene::stand_in_for_light(std::uint32_t index, const shading::LightData& light) {
    shading::LightData record = light;
    record.shadow = light_shadows_[index];
    return device_.upload(lights_.buffer(), std::span<const shading::LightData>(&record, 1), index * sizeof(record));
}

void GpuScene::classify() {
    bounds_ = flat_.bounds();
    features_ = scene_features(flat_);
    has_tested_ = has_blended_ = false;
    for (const shading::InstanceData& instance : flat_.instances()) {
        if (!(instance.flags & shading::instance_flag_visible)) continue;
        const std::uint32_t flags = flat_.materials()[instance.material].flags;
        has_blended_ |= (flags & shading::material_flag_alpha_blend) != 0;
        has_tested_ |= (flags & shading::material_flag_alpha_mask) != 0;
    }
}

Result<RealtimeUpdate> GpuScene::update(const Scene& scene) {
    convert::FlatChanges changes = flat_.update(scene);
    surfaces_.follow(flat_, changes);
    RealtimeUpdate update;
    const std::uint64_t bytes_before = device_.bytes_uploaded();
    if (changes.everything) {
        for (std::uint32_t i = 0; i < allocations_.size(); ++i) release_geometry(i);
        changes.geometries = all_of(flat_.geometries().size());
        changes.textures = all_of(flat_.textures().size());
        changes.materials = all_of(flat_.materials().size());
        changes.instances = all_of(flat_.instances().size());
        changes.lights = all_of(flat_.lights().size());
        changes.sky = true;
        light_shadows_.clear();
    }
    const bool compact = scene.convert_settings().vertex_precision == ConvertSettings::Precision::compact;
    if (compact != compact_) changes.geometries = all_of(flat_.geometries().size());
    compact_ = compact;
    // Every table exists, even for an empty scene: descriptors always point at something.
    for (GrowingBuffer* buffer : {&geometries_, &instances_, &materials_, &lights_, &active_lights_, &luminaires_})
        if (auto done = buffer->reserve(device_, smallest_buffer_bytes, 0); !done) return tl::unexpected(done.error());

    if (auto done = upload_geometries(changes.geometries, update); !done) return tl::unexpected(done.error());
    auto textures_changed = upload_textures(changes.textures, update);
    if (!textures_changed) return tl::unexpected(textures_changed.error());
    if (*textures_changed) changes.materials = all_of(flat_.materials().size());
    if (auto done = upload_materials(changes.materials, update); !done) return tl::unexpected(done.error());
    update.instances_uploaded = static_cast<int>(changes.instances.size());
    if (auto done = upload_elements<shading::InstanceData>(device_, instances_, flat_.instances(), changes.instances); !done)
        return tl::unexpected(done.error());
    update.lights_uploaded = static_cast<int>(changes.lights.size());
    for (const std::uint32_t light : changes.lights)
        if (light < light_shadows_.size()) light_shadows_[light] = shading::no_texture - 1;  // forces its upload
    light_shadows_.resize(flat_.lights().size(), shading::no_texture - 1);
    if (changes.luminaires || changes.everything) {
        const std::span<const float> table = flat_.luminaire_table();
        if (auto done = upload_elements<float>(device_, luminaires_, table, all_of(table.size())); !done) return tl::unexpected(done.error());
    }
    if (changes.sky || !sky_.size()) {
        if (auto done = upload_sky(); !done) return tl::unexpected(done.error());
        ++sky_revision_;
    }
    if (changes.any()) {
        ++revision_;
        classify();
    }
    if (!changes.lights.empty()) ++light_revision_;
    update.bytes_uploaded = device_.bytes_uploaded() - bytes_before;
    return update;
}

void GpuScene::append_bindings(std::vector<gpu::Binding>& bindings) const {
    for (const GrowingBuffer* table : {&vertices_, &indices_, &geometries_, &instances_, &materials_, &lights_,
                                       &active_lights_, &sky_})
        bindings.emplace_back(table->buffer());
}

}  // namespace heliodon::realtime
