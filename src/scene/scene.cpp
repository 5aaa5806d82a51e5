#include "scene/scene.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace heliodon {
namespace {

constexpr std::size_t journal_limit = std::size_t{1} << 20;

void complete_bounds(Geometry& geometry) {
    geometry.bounds = geometry.mesh.bounds();
    if (geometry.shape) geometry.bounds.include(bounds(*geometry.shape));
}

template <class Table>
auto find_by_name(const Table& table, std::string_view name) {
    for (std::uint32_t i = 0; i < table.capacity(); ++i) {
        const auto* value = table.at(i);
        if (value && value->name == name) return table.id_at(i);
    }
    return typename Table::Id{};
}

bool equal(const Transform& a, const Transform& b) {
    return a.translation == b.translation && a.rotation == b.rotation && a.scale == b.scale;
}

}  // namespace

glm::mat4 Transform::matrix() const {
    glm::mat4 result = glm::mat4_cast(rotation);
    for (int axis = 0; axis < 3; ++axis) result[axis] *= scale[axis];
    result[3] = glm::vec4(translation, 1.0f);
    return result;
}

glm::quat rotation_from_euler_deg(glm::vec3 degrees) {
    const glm::dvec3 half = glm::radians(glm::dvec3(degrees)) * 0.5;
    const glm::dquat x(std::cos(half.x), std::sin(half.x), 0, 0);
    const glm::dquat y(std::cos(half.y), 0, std::sin(half.y), 0);
    const glm::dquat z(std::cos(half.z), 0, 0, std::sin(half.z));
    return glm::quat(x * y * z);
}

// -- reading

glm::mat4 Scene::world_matrix(NodeId id) const {
    glm::mat4 result(1.0f);
    for (const Node* node = nodes_.find(id); node; node = nodes_.find(node->links.parent))
        result = node->local_matrix() * result;
    return result;
}

bool Scene::world_visible(NodeId id) const {
    const Node* node = nodes_.find(id);
    if (!node) return false;
    for (; node; node = nodes_.find(node->links.parent))
        if (!node->visible) return false;
    return true;
}

Bounds Scene::bounds() const {
    Bounds result;
    std::vector<std::pair<NodeId, glm::mat4>> pending;  // a stack: hierarchies may be deeper than the call stack
    for (const NodeId root : roots_) pending.emplace_back(root, glm::mat4(1.0f));
    while (!pending.empty()) {
        const auto [id, parent_to_world] = pending.back();
        pending.pop_back();
        const Node& node = *nodes_.find(id);
        if (!node.visible) continue;
        const glm::mat4 to_world = parent_to_world * node.local_matrix();
        for (const Part& part : node.parts)
            if (const Geometry* geometry = geometries_.find(part.geometry))
                result.include(geometry->bounds.transformed(to_world));
        for (const NodeId child : node.links.children) pending.emplace_back(child, to_world);
    }
    return result;
}

NodeId Scene::find_node(std::string_view name) const {
    return find_by_name(nodes_, name);
}
MaterialId Scene::find_material(std::string_view name) const {
    return find_by_name(materials_, name);
}
CameraId Scene::find_camera(std::string_view name) const {
    return find_by_name(cameras_, name);
}

// -- adding and removing

void Scene::record(Change::Table table, std::uint8_t aspects, std::uint32_t index) {
    journal_.push_back({table, aspects, index});
    if (journal_.size() > journal_limit) {
        journal_.pop_front();
        ++journal_begin_;
    }
}

std::vector<NodeId>& Scene::siblings(const Node& node) {
    Node* parent = nodes_.find(node.links.parent);
    return parent ? parent->links.children : roots_;
}

NodeId Scene::add_node(Node node, NodeId parent) {
    if (parent && !nodes_.contains(parent)) return {};
    node.links.parent = parent;
    node.links.children.clear();
    const NodeId id = nodes_.insert(std::move(node));
    siblings(*nodes_.find(id)).push_back(id);
    record(Change::Table::node, Change::added, id.index);
    return id;
}

GeometryId Scene::add_geometry(Geometry geometry) {
    complete_bounds(geometry);
    const GeometryId id = geometries_.insert(std::move(geometry));
    record(Change::Table::geometry, Change::added, id.index);
    return id;
}

GeometryId Scene::add_shape(Shape shape, std::string name) {
    Geometry geometry{std::move(name), tessellate(shape, convert_.shape_segments), std::move(shape), {}};
    return add_geometry(std::move(geometry));
}

TextureId Scene::add_texture(Texture texture) {
    const TextureId id = textures_.insert(std::move(texture));
    record(Change::Table::texture, Change::added, id.index);
    return id;
}

MaterialId Scene::add_material(Material material) {
    const MaterialId id = materials_.insert(std::move(material));
    record(Change::Table::material, Change::added, id.index);
    return id;
}

CameraId Scene::add_camera(Camera camera) {
    const CameraId id = cameras_.insert(std::move(camera));
    record(Change::Table::camera, Change::added, id.index);
    return id;
}

SensorId Scene::add_sensor(Sensor sensor) {
    const SensorId id = sensors_.insert(std::move(sensor));
    record(Change::Table::sensor, Change::added, id.index);
    return id;
}

AnimationId Scene::add_animation(Animation animation) {
    const AnimationId id = animations_.insert(std::move(animation));
    record(Change::Table::animation, Change::added, id.index);
    return id;
}

bool Scene::remove(NodeId id) {
    const Node* node = nodes_.find(id);
    if (!node) return false;
    std::erase(siblings(*node), id);
    std::vector<NodeId> subtree{id};
    for (std::size_t i = 0; i < subtree.size(); ++i) {
        const std::vector<NodeId>& children = nodes_.find(subtree[i])->links.children;
        subtree.insert(subtree.end(), children.begin(), children.end());
    }
    for (const NodeId below : subtree) {
        nodes_.erase(below);
        record(Change::Table::node, Change::removed, below.index);
    }
    return true;
}

bool Scene::remove(GeometryId id) {
    if (!geometries_.erase(id)) return false;
    record(Change::Table::geometry, Change::removed, id.index);
    return true;
}

bool Scene::remove(TextureId id) {
    if (!textures_.erase(id)) return false;
    record(Change::Table::texture, Change::removed, id.index);
    return true;
}

bool Scene::remove(MaterialId id) {
    if (!materials_.erase(id)) return false;
    record(Change::Table::material, Change::removed, id.index);
    return true;
}

bool Scene::remove(CameraId id) {
    if (!cameras_.erase(id)) return false;
    record(Change::Table::camera, Change::removed, id.index);
    return true;
}

bool Scene::remove(SensorId id) {
    if (!sensors_.erase(id)) return false;
    record(Change::Table::sensor, Change::removed, id.index);
    return true;
}

bool Scene::remove(AnimationId id) {
    if (!animations_.erase(id)) return false;
    record(Change::Table::animation, Change::removed, id.index);
    return true;
}

// -- editing

bool Scene::set_transform(NodeId id, const Transform& transform) {
    Node* node = nodes_.find(id);
    if (!node) return false;
    if (!node->matrix && equal(node->transform, transform)) return true;
    node->transform = transform;
    node->matrix.reset();
    record(Change::Table::node, Change::transform, id.index);
    return true;
}

bool Scene::set_matrix(NodeId id, const glm::mat4& matrix) {
    Node* node = nodes_.find(id);
    if (!node) return false;
    node->matrix = matrix;
    record(Change::Table::node, Change::transform, id.index);
    return true;
}

bool Scene::set_parts(NodeId id, std::vector<Part> parts) {
    Node* node = nodes_.find(id);
    if (!node) return false;
    node->parts = std::move(parts);
    record(Change::Table::node, Change::parts, id.index);
    return true;
}

bool Scene::set_light(NodeId id, std::optional<Light> light) {
    Node* node = nodes_.find(id);
    if (!node) return false;
    node->light = std::move(light);
    record(Change::Table::node, Change::light, id.index);
    return true;
}

bool Scene::set_visible(NodeId id, bool visible) {
    Node* node = nodes_.find(id);
    if (!node) return false;
    if (node->visible == visible) return true;
    node->visible = visible;
    record(Change::Table::node, Change::visibility, id.index);
    return true;
}

bool Scene::set_name(NodeId id, std::string name) {
    Node* node = nodes_.find(id);
    if (!node) return false;
    node->name = std::move(name);
    record(Change::Table::node, Change::value, id.index);
    return true;
}

bool Scene::set_parent(NodeId id, NodeId parent) {
    Node* node = nodes_.find(id);
    if (!node || (parent && !nodes_.contains(parent))) return false;
    for (NodeId above = parent; above; above = nodes_.find(above)->links.parent)
        if (above == id) return false;
    if (node->links.parent == parent) return true;
    std::erase(siblings(*node), id);
    node->links.parent = parent;
    siblings(*node).push_back(id);
    record(Change::Table::node, Change::hierarchy, id.index);
    return true;
}

bool Scene::set_geometry(GeometryId id, Geometry geometry) {
    Geometry* present = geometries_.find(id);
    if (!present) return false;
    complete_bounds(geometry);
    *present = std::move(geometry);
    record(Change::Table::geometry, Change::value, id.index);
    return true;
}

bool Scene::set_texture(TextureId id, Texture texture) {
    Texture* present = textures_.find(id);
    if (!present) return false;
    *present = std::move(texture);
    record(Change::Table::texture, Change::value, id.index);
    return true;
}

bool Scene::set_material(MaterialId id, Material material) {
    Material* present = materials_.find(id);
    if (!present) return false;
    *present = std::move(material);
    record(Change::Table::material, Change::value, id.index);
    return true;
}

bool Scene::set_camera(CameraId id, Camera camera) {
    Camera* present = cameras_.find(id);
    if (!present) return false;
    *present = std::move(camera);
    record(Change::Table::camera, Change::value, id.index);
    return true;
}

bool Scene::set_sensor(SensorId id, Sensor sensor) {
    Sensor* present = sensors_.find(id);
    if (!present) return false;
    *present = std::move(sensor);
    record(Change::Table::sensor, Change::value, id.index);
    return true;
}

void Scene::set_sky(const Sky& sky) {
    sky_ = sky;
    record(Change::Table::sky, Change::value, 0);
}

void Scene::set_convert_settings(const ConvertSettings& settings) {
    const bool tessellate_again = settings.shape_segments != convert_.shape_segments;
    convert_ = settings;
    record(Change::Table::settings, Change::value, 0);
    if (!tessellate_again) return;
    for (std::uint32_t i = 0; i < geometries_.capacity(); ++i) {
        const Geometry* geometry = geometries_.at(i);
        if (!geometry || !geometry->shape) continue;
        Geometry finer{geometry->name, tessellate(*geometry->shape, convert_.shape_segments), geometry->shape, {}};
        set_geometry(geometries_.id_at(i), std::move(finer));
    }
}

void Scene::set_render_settings(RenderSettings settings) {
    render_ = std::move(settings);
    record(Change::Table::settings, Change::value, 0);
}

}  // namespace heliodon
