#include "trace/geometry_table.h"

namespace heliodon::trace {
namespace {

using shading::KernelGeometry;

std::uint32_t attributes_of(const Mesh& mesh) {
    const std::size_t vertices = mesh.positions.size();
    std::uint32_t attributes = 0;
    if (mesh.normals.size() == vertices) attributes |= shading::kernel_has_normals;
    if (mesh.tangents.size() == vertices) attributes |= shading::kernel_has_tangents;
    if (mesh.texcoords[0].size() == vertices) attributes |= shading::kernel_has_texcoord0;
    if (mesh.texcoords[1].size() == vertices) attributes |= shading::kernel_has_texcoord1;
    if (mesh.colors.size() == vertices) attributes |= shading::kernel_has_colors;
    return attributes;
}

KernelGeometry kernel_geometry(const Geometry& geometry) {
    KernelGeometry result{};
    result.shape = shading::kernel_shape_triangles;
    result.attributes = attributes_of(geometry.mesh);
    if (!geometry.shape) return result;
    if (std::holds_alternative<Quad>(*geometry.shape)) result.shape = shading::kernel_shape_quad;
    if (const auto* disk = std::get_if<Disk>(&*geometry.shape)) {
        const glm::vec3 normal = glm::normalize(disk->normal);
        result.shape = shading::kernel_shape_disk;
        result.center = disk->center;
        result.radius = disk->radius;
        result.axis0 = disk_tangent(normal);
        result.axis1 = glm::cross(normal, result.axis0);
    }
    if (const auto* sphere = std::get_if<Sphere>(&*geometry.shape)) {
        result.shape = shading::kernel_shape_sphere;
        result.center = sphere->center;
        result.radius = sphere->radius;
    }
    return result;
}

}  // namespace

GeometryTable build_geometry_table(const convert::FlatScene& flat) {
    GeometryTable table(flat.geometries().size());
    for (std::size_t i = 0; i < table.size(); ++i) {
        const Geometry* geometry = flat.geometries()[i];
        if (!geometry) continue;
        const Mesh& mesh = geometry->mesh;
        table[i] = {mesh.indices.data(),       mesh.positions.data(),
                    mesh.normals.data(),       mesh.tangents.data(),
                    mesh.colors.data(),        {mesh.texcoords[0].data(), mesh.texcoords[1].data()},
                    kernel_geometry(*geometry)};
    }
    return table;
}

}  // namespace heliodon::trace
