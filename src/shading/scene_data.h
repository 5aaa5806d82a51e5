// The flat scene records that both engines read: std430 in GLSL, the same bytes in C++ (every member
// is 4- or 16-byte sized and placed so that no padding differs). Written by the convert room.
#ifndef HELIODON_SHADING_SCENE_DATA_H
#define HELIODON_SHADING_SCENE_DATA_H
#include "shading/language.h"
SHADING_BEGIN

SHADING_CONST uint no_texture = 0xffffffffu;

/// uv' = mat2(matrix.xy, matrix.zw as columns) · uv + offset
struct TextureRef {
    vec4 uv_matrix;
    vec2 uv_offset;
    uint texture_index;  // slot in the bindless table, or no_texture
    uint texcoord;       // 0 or 1
};

SHADING_CONST uint material_model_standard = 0u;
SHADING_CONST uint material_model_lambert = 1u;
SHADING_CONST uint material_model_unlit = 2u;
SHADING_CONST uint material_model_thin = 3u;  // a pane: what it does not mirror passes straight on
SHADING_CONST uint material_model_disney = 4u;
SHADING_CONST uint material_model_oren_nayar = 5u;
SHADING_CONST uint material_model_conductor = 6u;   // the standard model's metal with eta and k
SHADING_CONST uint material_model_dielectric = 7u;  // the standard model's clear glass
SHADING_CONST uint material_flag_two_sided = 1u;
SHADING_CONST uint material_flag_alpha_mask = 2u;
SHADING_CONST uint material_flag_alpha_blend = 4u;
SHADING_CONST uint material_flag_emissive = 8u;
SHADING_CONST uint material_flag_extended = 16u;     // it needs what SHADING's extended models have (surface.h)
SHADING_CONST uint material_flag_thin_walled = 32u;  // transmission passes a sheet

struct MaterialData {
    vec3 base_color;
    float opacity;
    vec3 emission_nits;
    float alpha_cutoff;
    vec3 specular_color;
    float specular;
    float metallic;
    float roughness;
    float ior;
    float transmission;
    float clearcoat;
    float clearcoat_roughness;
    float normal_scale;
    float bump_scale_m;
    float occlusion_strength;
    uint model;
    uint flags;
    uint padding;
    TextureRef base_color_texture;
    TextureRef orm_texture;
    TextureRef occlusion_texture;
    TextureRef normal_texture;
    TextureRef bump_texture;
    TextureRef emission_texture;
    TextureRef transmission_texture;
    TextureRef specular_texture;
    TextureRef specular_color_texture;
    TextureRef clearcoat_texture;
    TextureRef clearcoat_roughness_texture;
    vec4 transmittance;       // thin: coefficients of the cosine of incidence, 0th to 3rd power
    vec2 transmittance_high;  // 4th and 5th power
    float reflectance;        // thin: share that is mirrored, at any incidence
    // Extended, from here on.
    float anisotropy;  // disney: anisotropic
    vec3 sheen_color;
    float sheen_roughness;
    vec3 conductor_eta;
    float iridescence;
    vec3 conductor_k;
    float film_ior;
    vec3 conductor_average;   // cosine-weighted average of its reflectance
    float film_thickness_nm;  // where the texture is 1
    vec3 absorption;          // of a solid, 1/m
    float film_thinnest_nm;   // where the texture is 0
    vec2 anisotropy_axis;     // cosine and sine of its angle from the tangent, towards the bitangent
    float subsurface;         // disney
    float specular_tint;
    float sheen;
    float sheen_tint;
    float clearcoat_gloss;
    float sigma;  // oren_nayar: radians; negative: by roughness
    TextureRef anisotropy_texture;
    TextureRef sheen_color_texture;
    TextureRef sheen_roughness_texture;
    TextureRef iridescence_texture;
    TextureRef film_thickness_texture;
};

SHADING_CONST uint light_type_point = 0u;
SHADING_CONST uint light_type_spot = 1u;
SHADING_CONST uint light_type_directional = 2u;
SHADING_CONST uint light_type_lambertian = 3u;  // a point light with a cosine distribution about its axis
SHADING_CONST uint light_type_none = 4u;        // a hole in the table
SHADING_CONST uint light_type_luminaire = 5u;   // a measured distribution: shading/luminaire.h

// Luminous openings of luminaires, in their table's axes. Without an extent: half_extent is 0.
SHADING_CONST uint opening_box = 0u;
SHADING_CONST uint opening_cylinder_x = 1u;  // elliptic, along that axis
SHADING_CONST uint opening_cylinder_y = 2u;
SHADING_CONST uint opening_cylinder_z = 3u;
SHADING_CONST uint opening_ellipsoid = 4u;
SHADING_CONST uint opening_shape_bits = 0xffu;
SHADING_CONST uint opening_sun = 0x200u;  // a directional light whose disc darkens towards its limb and sets behind the ground
SHADING_CONST uint opening_mirrored = 0x100u;  // azimuth angles run the other way round

struct LightData {
    vec3 position;  // metres, world
    float radius;   // metres; directional: angular radius, radians; luminaire: of the sphere round its opening
    vec3 axis;      // unit; where the light aims (point lights of a sphere: unused); luminaire: polar angle 0
    uint type;
    vec3 intensity;  // cd on axis; directional: lux; luminaire: peak, which its table's values are relative to
    float cos_inner;
    float cos_outer;
    uint shadow;  // index of the first shadow view, or no_texture: the real-time engine's own
    float cone_radius;  // as radius, of a light that stands in one point and casts its shadow by a cone: likewise
    float flux_factor;  // luminaire: flux / peak intensity, sr
    // Luminaires alone. Their axes: x azimuth 0, y azimuth 90°, z `axis`.
    vec3 tangent;  // unit: x
    uint table;    // where its table begins (luminaire_value)
    vec3 half_extent;  // of the luminous opening, m
    uint opening;      // opening_… shape and flags; directional lights: opening_sun or 0
    vec3 weighted_normal;  // one point of an opening with a volume (opening_surface_point), world; else 0
    uint face_weights;     // of the opening: how often opening_surface_point picks each
};

/// One drawable: a part of a node.
struct InstanceData {
    mat4 object_to_world;
    mat4 normal_to_world;  // inverse transpose of the upper 3×3
    uint geometry;
    uint material;
    uint flags;  // instance_flag_…
    float determinant_sign;  // −1 where the transform mirrors
};
SHADING_CONST uint instance_flag_visible = 1u;
SHADING_CONST uint instance_flag_in_place = 2u;  // object_to_world changes nothing

SHADING_CONST uint sky_model_none = 0u;
SHADING_CONST uint sky_model_constant = 1u;
SHADING_CONST uint sky_model_image = 2u;
SHADING_CONST uint sky_model_cie = 3u;       // ISO 15469's fifteen types
SHADING_CONST uint sky_model_overcast = 4u;  // and its traditional overcast sky
SHADING_CONST uint sky_model_hosek = 5u;
SHADING_CONST uint sky_model_preetham = 6u;
struct SkyData {
    // constant: cd/m²; image: scale; cie: cd/m² where gradation and indicatrix are 1; overcast: zenith; hosek, preetham: the
    // even part, of a night
    vec3 luminance;
    uint model;
    uint texture_index;
    float north_rad;
    float horizon;  // hosek, preetham: added to the cosine of the zenith angle in the gradation
    float indicatrix_e;
    vec4 gradation_indicatrix;  // cie: the standard's a, b, c, d
    vec3 sun_direction;         // unit, towards the sun; hosek, preetham: or to where it set
    float padding;
    vec3 ground;  // formulas: cd/m² below the horizon
    float padding2;
    // hosek, preetham: A, B, C, D, E, F, G, I, H of daylight_values, each of three values; then what X, Y, Z are multiplied by
    vec4 daylight[10];
};

SHADING_END
#endif
