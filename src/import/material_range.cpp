#include "import/material_range.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

#include "import/import_failure.h"

namespace heliodon::import {

bool bring_into_range(Material& material, const std::string& where) {
    const glm::vec3 e = material.emission_nits, s = material.specular_color;
    const float sum = e.x + e.y + e.z + s.x + s.y + s.z + material.ior + material.normal_scale + material.bump_scale_m;
    if (!std::isfinite(sum)) refuse(where, "expected factors that single precision holds");
    bool changed = false;
    for (float* share :
         {&material.opacity, &material.alpha_cutoff, &material.metallic, &material.roughness, &material.transmission,
          &material.specular, &material.clearcoat, &material.clearcoat_roughness, &material.occlusion_strength,
          &material.base_color.x, &material.base_color.y, &material.base_color.z, &material.anisotropy, &material.sheen_roughness,
          &material.sheen_color.x, &material.sheen_color.y, &material.sheen_color.z, &material.iridescence,
          &material.attenuation_color.x, &material.attenuation_color.y, &material.attenuation_color.z}) {
        const float inside = std::clamp(*share, 0.0f, 1.0f);
        changed |= inside != *share;
        *share = inside;
    }
    for (float* length : {&material.iridescence_thickness_nm, &material.iridescence_thinnest_nm}) {
        const float inside = std::max(*length, 0.0f);
        changed |= inside != *length;
        *length = inside;
    }
    if (material.iridescence_ior < 1.0f) changed = true, material.iridescence_ior = 1.0f;
    for (glm::vec3* color : {&material.emission_nits, &material.specular_color}) {
        const glm::vec3 inside = glm::max(*color, glm::vec3(0));
        changed |= inside != *color;
        *color = inside;
    }
    return changed;
}

}  // namespace heliodon::import
