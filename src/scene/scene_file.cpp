#include "scene/scene_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "core/image_io.h"
#include "scene/model_placement.h"
#include "scene/scene_file_parts.h"
#include "scene/scene_overrides.h"

namespace heliodon {
namespace scene_file {
namespace {

constexpr int format_version = 1;

/// Names of one kind, each used once.
class UniqueNames {
public:
    explicit UniqueNames(std::string_view kind) : kind_(kind) {}
    void add(const std::string& name, const JsonCursor& owner) {
        if (!name.empty() && !names_.insert(name).second)
            throw Refusal{owner.path() + ".name",
                          fmt::format("expected a name that no other {} has, found \"{}\" again", kind_, name)};
    }

private:
    std::string_view kind_;
    std::set<std::string> names_;
};

/// Reads a document into a scene. Every file that the document names is opened after the whole of the document is
/// found right, so that a slip near its end does not cost the loading of its models.
class Reader {
public:
    Reader(const std::filesystem::path& base, const SceneFileReaders& readers, Warnings& warnings)
        : base_(base), readers_(readers), warnings_(warnings) {}

    Scene read(const Json& document);

private:
    struct TextureJob {
        MaterialId material;
        MaterialTextures files;
        std::string path;
    };
    struct ModelJob {
        NodeId node;
        std::filesystem::path file;
        std::optional<MaterialId> material;
        std::string path;
    };

    struct LuminaireJob {
        NodeId node;
        LightBlock::Photometry photometry;
        std::string path;
    };

    void read_settings(ObjectReader& root);
    void read_materials(ObjectReader& root);
    void read_nodes(const JsonCursor& list, NodeId parent);
    void read_node(const JsonCursor& cursor, NodeId parent);
    Transform read_transform(ObjectReader& object);
    void read_drawable(ObjectReader& object, NodeId id);
    GeometryId shared_shape(const JsonCursor& cursor, const std::string& name);
    void load_textures();
    void load_sky_image();
    void load_models();
    void load_luminaires();
    void blend_where_opacity_moves(const Animation& animation);

    [[nodiscard]] std::filesystem::path resolve(const std::filesystem::path& file) const {
        return file.empty() ? file : base_ / file;
    }

    std::filesystem::path base_;
    const SceneFileReaders& readers_;
    Warnings& warnings_;
    Scene scene_;
    std::map<std::string, GeometryId> shapes_;  ///< by their text
    std::vector<TextureJob> texture_jobs_;
    std::vector<ModelJob> model_jobs_;
    std::vector<LuminaireJob> luminaire_jobs_;
    std::filesystem::path sky_image_;
    UniqueNames node_names_{"node"};
};

Scene Reader::read(const Json& document) {
    ObjectReader root(JsonCursor(document, "$"));
    (void)root.require("heliodon").integer(format_version, format_version);
    read_settings(root);
    read_materials(root);
    if (const auto nodes = root.find("nodes")) read_nodes(*nodes, {});
    const auto animations = root.find("animations");
    root.finish();
    load_textures();
    load_sky_image();
    load_models();
    load_luminaires();
    if (animations) {
        UniqueNames names("animation");
        for (const JsonCursor& cursor : animations->elements()) {
            Animation animation = read_animation(cursor, scene_);
            names.add(animation.name, cursor);
            blend_where_opacity_moves(animation);
            scene_.add_animation(std::move(animation));
        }
    }
    return std::move(scene_);
}

void Reader::read_settings(ObjectReader& root) {
    if (const auto convert = root.find("convert")) scene_.set_convert_settings(read_convert_settings(*convert));
    if (const auto render = root.find("render")) scene_.set_render_settings(read_render_settings(*render));
    if (const auto probes = root.find("probes")) check_probes(*probes);
    if (const auto sky = root.find("sky")) {
        const SkyBlock block = read_sky(*sky);
        sky_image_ = block.image;
        scene_.set_sky(block.sky);
    }
    if (const auto cameras = root.find("cameras")) {
        UniqueNames names("camera");
        for (const JsonCursor& cursor : cameras->elements()) {
            Camera camera = read_camera(cursor);
            names.add(camera.name, cursor);
            scene_.add_camera(std::move(camera));
        }
    }
    if (const auto sensors = root.find("sensors")) {
        UniqueNames names("sensor");
        for (const JsonCursor& cursor : sensors->elements()) {
            Sensor sensor = read_sensor(cursor);
            names.add(sensor.name, cursor);
            scene_.add_sensor(std::move(sensor));
        }
    }
}

void Reader::read_materials(ObjectReader& root) {
    const auto materials = root.find("materials");
    if (!materials) return;
    for (const auto& [name, cursor] : materials->members()) {
        MaterialBlock block = read_material(name, cursor);
        MaterialTextures& files = block.textures;
        bool textured = false;
        for (std::filesystem::path* file : {&files.base_color, &files.roughness, &files.metallic, &files.occlusion,
                                            &files.normal, &files.bump, &files.emission, &files.opacity}) {
            textured = textured || !file->empty();
            *file = resolve(*file);
        }
        const MaterialId id = scene_.add_material(std::move(block.material));
        if (textured) texture_jobs_.push_back({id, std::move(files), cursor.path()});
    }
}

void Reader::read_nodes(const JsonCursor& list, NodeId parent) {
    for (const JsonCursor& cursor : list.elements()) read_node(cursor, parent);
}

Transform Reader::read_transform(ObjectReader& object) {
    Transform transform;
    object.read("translate", transform.translation);
    if (const auto rotation = object.find("rotate_deg"))
        transform.rotation = rotation_from_euler_deg(rotation->vector());
    if (const auto scale = object.find("scale")) transform.scale = scale->number_or_vector(not_zero);
    return transform;
}

void Reader::read_node(const JsonCursor& cursor, NodeId parent) {
    ObjectReader object(cursor);
    Node node;
    if (const auto name = object.find("name")) node.name = name->string();
    node_names_.add(node.name, cursor);
    node.transform = read_transform(object);
    object.read("visible", node.visible);
    const auto light = object.find("light");
    const LightBlock block = light ? read_light(*light) : LightBlock{};
    if (light) node.light = block.light;
    const NodeId id = scene_.add_node(std::move(node), parent);
    if (block.photometry) luminaire_jobs_.push_back({id, *block.photometry, light->path()});
    read_drawable(object, id);
    const auto children = object.find("children");
    object.finish();
    if (children) read_nodes(*children, id);
}

void Reader::read_drawable(ObjectReader& object, NodeId id) {
    const auto shape = object.find("shape"), mesh = object.find("mesh"), material = object.find("material");
    if (shape && mesh) throw Refusal{object.cursor().path(), "expected a shape or a mesh, found both"};
    std::optional<MaterialId> material_id;
    if (material) {
        material_id = scene_.find_material(material->string());
        if (!*material_id) material->refuse("the name of one of the file's materials");
        if (!shape && !mesh)
            throw Refusal{material->path(), "expected a shape or a mesh beside the material, found neither"};
    }
    if (mesh) model_jobs_.push_back({id, resolve(mesh->file()), material_id, mesh->path()});
    if (!shape) return;
    scene_.set_parts(id, {{shared_shape(*shape, scene_.nodes().find(id)->name), material_id.value_or(MaterialId{})}});
}

/// Equal shapes share one geometry, so that ten thousand equal boxes cost one.
GeometryId Reader::shared_shape(const JsonCursor& cursor, const std::string& name) {
    const auto [known, is_new] = shapes_.try_emplace(cursor.json().dump(-1, ' ', false, Json::error_handler_t::replace));
    if (!is_new) return known->second;
    std::variant<Shape, Mesh> form = read_shape(cursor);
    known->second = std::holds_alternative<Shape>(form)
                        ? scene_.add_shape(std::get<Shape>(form), name)
                        : scene_.add_geometry({name, std::get<Mesh>(std::move(form)), std::nullopt, {}});
    return known->second;
}

void Reader::load_textures() {
    for (const TextureJob& job : texture_jobs_) {
        if (!readers_.material_textures)
            throw Refusal{job.path, "expected no textures: this reader cannot decode pictures"};
        Material material = *scene_.materials().find(job.material);
        const Result<void> read = readers_.material_textures(scene_, material, job.files, warnings_);
        if (!read) throw Refusal{job.path, read.error().text()};
        scene_.set_material(job.material, std::move(material));
    }
}

void Reader::load_sky_image() {
    if (sky_image_.empty()) return;
    if (!readers_.sky_image) throw Refusal{"$.sky.image", "expected no image: this reader cannot decode pictures"};
    const Result<TextureId> image = readers_.sky_image(scene_, resolve(sky_image_));
    if (!image) throw Refusal{"$.sky.image", image.error().text()};
    Sky sky = scene_.sky();
    sky.image = *image;
    scene_.set_sky(sky);
}

void Reader::load_models() {
    ModelPlacement placement(scene_, readers_.model, warnings_);
    for (const ModelJob& job : model_jobs_) {
        if (!readers_.model) throw Refusal{job.path, "expected no meshes: this reader cannot read models"};
        const Result<void> placed = placement.place(job.node, job.file, job.material);
        if (!placed) throw Refusal{job.path, placed.error().text()};
    }
    placement.remove_replaced_materials();
}

void Reader::load_luminaires() {
    for (const LuminaireJob& job : luminaire_jobs_) {
        if (!readers_.luminaire) throw Refusal{job.path, "expected no luminaires: this reader cannot read photometric files"};
        auto luminaire = readers_.luminaire(resolve(job.photometry.file), job.photometry.lamp_set, warnings_);
        if (!luminaire) throw Refusal{job.path + ".file", luminaire.error().text()};
        Light light = *scene_.nodes().find(job.node)->light;
        light.luminaire = *std::move(luminaire);
        const double flux = light.luminaire->flux_lm;
        const double scale = job.photometry.flux_lm && flux > 0 ? *job.photometry.flux_lm / flux : 1.0;
        light.intensity = job.photometry.color * static_cast<float>(scale * job.photometry.scale * light.luminaire->peak_cd);
        if (!std::isfinite(light.intensity.x + light.intensity.y + light.intensity.z))
            throw Refusal{job.path, "expected a scale or flux whose intensity single precision holds, found more"};
        scene_.set_light(job.node, std::move(light));
    }
}

/// An opaque material has no use for an opacity; one whose opacity is animated blends.
void Reader::blend_where_opacity_moves(const Animation& animation) {
    for (const AnimationChannel& channel : animation.channels) {
        if (channel.property != AnimatedProperty::material_opacity) continue;
        const MaterialId id = std::get<MaterialId>(channel.target);
        Material material = *scene_.materials().find(id);
        if (material.alpha_mode != AlphaMode::opaque) continue;
        material.alpha_mode = AlphaMode::blend;
        scene_.set_material(id, std::move(material));
    }
}

bool is_at_or_below(std::string_view path, std::string_view ancestor) {
    if (!path.starts_with(ancestor)) return false;
    return path.size() == ancestor.size() || path[ancestor.size()] == '.' || path[ancestor.size()] == '[';
}

/// Whose fault the refusal is: an override's where it set or made the refused value, else the file's.
Error located(const Refusal& refusal, const std::string& name, std::span<const AppliedOverride> overrides) {
    for (auto applied = overrides.rbegin(); applied != overrides.rend(); ++applied) {
        if (!is_at_or_below(refusal.path, applied->first_made)) continue;
        const bool inside_value = !is_at_or_below(applied->json_path, refusal.path);
        return {inside_value ? applied->label + ": " + refusal.path : applied->label, refusal.message};
    }
    return {name + ": " + refusal.path, refusal.message};
}

}  // namespace
}  // namespace scene_file

Result<Scene> read_scene_file(const std::filesystem::path& path, std::span<const Override> overrides,
                              const SceneFileReaders& readers, Warnings& warnings) {
    const Result<std::string> text = read_file(path);
    if (!text) return tl::unexpected<Error>(text.error());
    return parse_scene(*text, path.string(), path.parent_path(), overrides, readers, warnings);
}

Result<Scene> parse_scene(std::string_view text, const std::string& name, const std::filesystem::path& base,
                          std::span<const Override> overrides, const SceneFileReaders& readers, Warnings& warnings) {
    using namespace scene_file;
    Result<Json> document = parse_document(text, name);
    if (!document) return tl::unexpected<Error>(document.error());
    std::vector<AppliedOverride> applied;
    try {
        if (!document->is_object()) JsonCursor(*document, "$").refuse("an object");
        Result<std::vector<AppliedOverride>> result = apply_overrides(*document, overrides);
        if (!result) return tl::unexpected<Error>(result.error());
        applied = *std::move(result);
        return Reader(base, readers, warnings).read(*document);
    } catch (const Refusal& refusal) {
        return tl::unexpected<Error>(located(refusal, name, applied));
    } catch (const std::exception& exception) {
        return fail(name, exception.what());
    }
}

}  // namespace heliodon
