#include <fmt/format.h>

#include <map>
#include <memory>
#include <tuple>
#include <utility>

#include "import/import.h"
#include "import/import_failure.h"
#include "import/material_files.h"

namespace heliodon {
namespace {

/// The textures that one scene file has made so far: the same pictures for the same use are decoded once.
class SharedTextures {
public:
    void read(Scene& scene, Material& material, const MaterialTextures& files) {
        import::MaterialFiles source{
            .files = files, .sampler = {}, .alpha_mode = material.alpha_mode, .alpha_cutoff = {}};
        if (material.alpha_mode == AlphaMode::mask && material.opacity > 0)
            source.alpha_cutoff = material.alpha_cutoff / material.opacity;
        import::TextureSet set;
        const import::TextureSlots slots = import::add_material_files(source, set);
        std::vector<TextureId> ids(set.size());
        import::TextureSet missing;
        std::vector<std::size_t> numbers;
        for (std::size_t i = 0; i < set.size(); ++i) {
            const auto found = known_.find(set.identity(int(i)));
            if (found != known_.end() && scene.textures().contains(found->second)) {
                ids[i] = found->second;
            } else {
                missing.add_from(set, int(i));
                numbers.push_back(i);
            }
        }
        std::vector<Texture> textures = missing.build();
        for (std::size_t k = 0; k < textures.size(); ++k)
            known_[set.identity(int(numbers[k]))] = ids[numbers[k]] = scene.add_texture(std::move(textures[k]));
        for (const auto& [slot, texture] : slots) (material.*slot).texture = ids[std::size_t(texture)];
    }

private:
    std::map<std::string, TextureId> known_;
};

/// The luminaires that one scene file has read so far: lights of one file share its table.
class SharedLuminaires {
public:
    Result<std::shared_ptr<const Luminaire>> read(const std::filesystem::path& path, int lamp_set, Warnings& warnings) {
        std::shared_ptr<const Luminaire>& known = known_[{path, lamp_set}];
        if (known) return known;
        auto luminaire = load_luminaire(path, lamp_set, warnings);
        if (luminaire) known = *luminaire;
        return luminaire;
    }

private:
    std::map<std::pair<std::filesystem::path, int>, std::shared_ptr<const Luminaire>> known_;
};

Result<TextureId> read_sky_image(Scene& scene, const std::filesystem::path& path) {
    Result<Texture> texture = load_texture(path, TextureFormat::float32);
    if (!texture) return tl::unexpected(texture.error());
    // Round the horizon a panorama closes; over the poles it ends.
    texture->wrap_u = Wrap::repeat;
    texture->wrap_v = Wrap::clamp_to_edge;
    return scene.add_texture(std::move(*texture));
}

}  // namespace

SceneFileReaders scene_file_readers() {
    auto shared = std::make_shared<SharedTextures>();
    auto luminaires = std::make_shared<SharedLuminaires>();
    return {.model = import_model,
            .material_textures =
                [shared](Scene& scene, Material& material, const MaterialTextures& files, Warnings&) {
                    return import::guarded({}, [&] { shared->read(scene, material, files); });
                },
            .sky_image = read_sky_image,
            .luminaire = [luminaires](const std::filesystem::path& path, int lamp_set, Warnings& warnings) {
                return luminaires->read(path, lamp_set, warnings);
            }};
}

}  // namespace heliodon
