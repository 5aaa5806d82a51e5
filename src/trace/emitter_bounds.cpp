#include "trace/emitter_bounds.h"

#include <cmath>
#include <numbers>

namespace heliodon::trace {
namespace {

constexpr double pi = std::numbers::pi;

LightBounds light_bounds(const shading::LightData& light, double lumen) {
    LightBounds bounds;
    bounds.box.include(light.position - glm::vec3(light.radius));
    bounds.box.include(light.position + glm::vec3(light.radius));
    bounds.axis = light.axis;
    switch (light.type) {
        case shading::light_type_spot:
            bounds.normals_rad = std::acos(light.cos_inner);
            bounds.emission_rad = std::acos(light.cos_outer) - bounds.normals_rad;
            // As flux: 2πI (1 − cos inner + (cos inner − cos outer)/3).
            bounds.intensity_cd =
                lumen / (2 * pi * (1.0 - light.cos_inner + (light.cos_inner - light.cos_outer) / 3.0));
            break;
        case shading::light_type_lambertian:
            bounds.emission_rad = pi / 2;
            bounds.intensity_cd = lumen / pi;
            break;
        default:  // points, and luminaires, which may shine anywhere
            bounds.normals_rad = pi;
            bounds.emission_rad = pi / 2;
            bounds.intensity_cd = lumen / (4 * pi);
    }
    return bounds;
}

/// The box round an ellipsoid: the instance's image of the sphere.
LightBounds sphere_bounds(const convert::FlatScene& flat, const shading::KernelEmitter& emitter, double lumen) {
    const shading::InstanceData& instance = flat.instances()[emitter.index];
    const float radius = std::get<Sphere>(*flat.geometries()[instance.geometry]->shape).radius;
    const glm::mat3 rows = glm::transpose(glm::mat3(instance.object_to_world));
    const glm::vec3 half(glm::length(rows[0]), glm::length(rows[1]), glm::length(rows[2]));
    LightBounds bounds;
    bounds.box.include(emitter.origin - radius * half);
    bounds.box.include(emitter.origin + radius * half);
    bounds.normals_rad = pi;
    bounds.emission_rad = pi / 2;
    bounds.intensity_cd = lumen / (4 * pi);
    return bounds;
}

}  // namespace

LightBounds emitter_bounds(const convert::FlatScene& flat, const shading::KernelEmitter& emitter, double lumen) {
    if (emitter.kind == shading::kernel_emitter_light) return light_bounds(flat.lights()[emitter.index], lumen);
    if (emitter.kind == shading::kernel_emitter_sphere) return sphere_bounds(flat, emitter, lumen);
    LightBounds bounds;
    const glm::vec3 &o = emitter.origin, &u = emitter.edge0, &v = emitter.edge1;
    if (emitter.kind == shading::kernel_emitter_disk) {
        const glm::vec3 half = glm::sqrt(u * u + v * v);  // of an ellipse with these conjugate semi-axes
        bounds.box.include(o - half);
        bounds.box.include(o + half);
    } else {
        for (const glm::vec3& corner : {o, o + u, o + v}) bounds.box.include(corner);
        if (emitter.kind != shading::kernel_emitter_triangle) bounds.box.include(o + u + v);
    }
    const shading::InstanceData& instance = flat.instances()[emitter.index];
    bounds.two_sided = flat.materials()[instance.material].flags & shading::material_flag_two_sided;
    const glm::dvec3 normal = glm::cross(glm::dvec3(u), glm::dvec3(v)) * static_cast<double>(emitter.orientation);
    if (glm::dot(normal, normal) > 0)
        bounds.axis = glm::vec3(glm::normalize(normal));
    else
        bounds.normals_rad = pi;  // too small to tell
    bounds.emission_rad = pi / 2;
    bounds.intensity_cd = lumen / ((bounds.two_sided ? 2 : 1) * pi);
    return bounds;
}

}  // namespace heliodon::trace
