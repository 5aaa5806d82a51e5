#include "trace/scene_digest.h"

#include <fmt/format.h>

#include <cstring>
#include <span>
#include <type_traits>

namespace heliodon::trace {
namespace {

/// Words of 64 bits, each multiplied into the state and mixed as by splitmix64's finalizer (Steele, Lea & Flood 2014,
/// "Fast Splittable Pseudorandom Number Generators", section 5).
class Digest {
public:
    void add_bytes(const void* data, std::size_t size) {
        add_word(size);
        const auto* bytes = static_cast<const std::byte*>(data);
        for (std::size_t i = 0; i < size; i += sizeof(std::uint64_t)) {
            std::uint64_t word = 0;
            std::memcpy(&word, bytes + i, std::min(size - i, sizeof word));
            add_word(word);
        }
    }
    template <class Range>
    void add(const Range& range) {
        using Value = std::remove_cvref_t<decltype(*std::data(range))>;
        static_assert(std::is_trivially_copyable_v<Value>);
        add_bytes(std::data(range), std::size(range) * sizeof(Value));
    }
    [[nodiscard]] std::string text() const { return fmt::format("{:016x}", state_); }

private:
    void add_word(std::uint64_t word) {
        state_ = (state_ ^ word) + 0x9e3779b97f4a7c15u;
        state_ = (state_ ^ (state_ >> 30)) * 0xbf58476d1ce4e5b9u;
        state_ = (state_ ^ (state_ >> 27)) * 0x94d049bb133111ebu;
        state_ ^= state_ >> 31;
    }
    std::uint64_t state_ = 0;
};

void add_mesh(const Mesh& mesh, Digest& digest) {
    digest.add(mesh.indices);
    digest.add(mesh.positions);
    digest.add(mesh.normals);
    digest.add(mesh.tangents);
    digest.add(mesh.colors);
    for (const auto& texcoords : mesh.texcoords) digest.add(texcoords);
}

void add_texture(const Texture& texture, Digest& digest) {
    const int properties[] = {texture.width,
                              texture.height,
                              static_cast<int>(texture.format),
                              static_cast<int>(texture.wrap_u),
                              static_cast<int>(texture.wrap_v),
                              static_cast<int>(texture.magnify),
                              static_cast<int>(texture.minify)};
    digest.add(properties);
    for (const auto& level : texture.levels) digest.add(level);
}

}  // namespace

std::string scene_digest(const CpuKernel& kernel) {
    Digest digest;
    const convert::FlatScene& flat = kernel.flat;
    digest.add(flat.instances());
    digest.add(flat.materials());
    digest.add(flat.lights());
    digest.add(flat.luminaire_table());
    digest.add_bytes(&flat.sky(), sizeof flat.sky());
    digest.add(flat.texture_first_levels());
    for (const Texture* texture : flat.textures())
        if (texture) add_texture(*texture, digest);
    for (std::size_t i = 0; i < flat.geometries().size(); ++i) {
        if (!flat.geometries()[i]) continue;
        add_mesh(flat.geometries()[i]->mesh, digest);
        digest.add_bytes(&kernel.geometry_table[i].kernel, sizeof(KernelGeometry));  // exact shapes
    }
    return digest.text();
}

std::string camera_digest(const shading::KernelFrame& frame) {
    Digest digest;
    const vec3 vectors[] = {frame.camera_position, frame.camera_forward, frame.camera_right, frame.camera_up};
    digest.add(vectors);
    return digest.text();
}

}  // namespace heliodon::trace
