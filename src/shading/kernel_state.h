// What the light-transport kernel (path_kernel.h) reads, keeps and hands over, in both languages.
#ifndef HELIODON_SHADING_KERNEL_STATE_H
#define HELIODON_SHADING_KERNEL_STATE_H
#include "shading/language.h"
SHADING_BEGIN

// -- rays and hits

SHADING_CONST uint kernel_ray_none = 0u;     // the path has ended
SHADING_CONST uint kernel_ray_scatter = 1u;  // wants the nearest hit
SHADING_CONST uint kernel_ray_shadow = 2u;   // wants: blocked, the nearest translucent surface, or nothing

struct KernelRay {
    vec3 origin;
    float t_max;
    vec3 direction;  // unit length
    uint kind;
};

SHADING_CONST uint kernel_hit_nothing = 0u;
SHADING_CONST uint kernel_hit_surface = 1u;
SHADING_CONST uint kernel_hit_blocked = 2u;  // shadow rays only: something opaque lies on the segment

struct KernelHit {
    vec3 object_normal;  // exact spheres: unit outward normal in object space; else unused
    float t;
    vec2 barycentric;  // triangles: weights of the second and third vertex; disks: (along e0, e1) / radius
    uint instance;
    uint primitive;
    uint kind;
};

// -- the scene beyond scene_data.h

SHADING_CONST uint kernel_shape_triangles = 0u;
SHADING_CONST uint kernel_shape_disk = 1u;
SHADING_CONST uint kernel_shape_sphere = 2u;
SHADING_CONST uint kernel_shape_quad = 3u;  // a parallelogram of two triangles

SHADING_CONST uint kernel_has_normals = 1u;
SHADING_CONST uint kernel_has_tangents = 2u;
SHADING_CONST uint kernel_has_texcoord0 = 4u;
SHADING_CONST uint kernel_has_texcoord1 = 8u;
SHADING_CONST uint kernel_has_colors = 16u;

struct KernelGeometry {
    vec3 center;  // disks and spheres, object space
    float radius;
    vec3 axis0;  // disks: an orthonormal frame, normal = cross(axis0, axis1); spheres: unused
    uint shape;
    vec3 axis1;
    uint attributes;  // kernel_has_…
};

/// A light, an emissive primitive or a sky that varies, as next-event estimation selects it.
SHADING_CONST uint kernel_emitter_light = 0u;  // `index` names a LightData
SHADING_CONST uint kernel_emitter_triangle = 1u;
SHADING_CONST uint kernel_emitter_quad = 2u;  // a parallelogram
SHADING_CONST uint kernel_emitter_disk = 3u;
SHADING_CONST uint kernel_emitter_sphere = 4u;
SHADING_CONST uint kernel_emitter_sky = 5u;
SHADING_CONST uint kernel_emitter_rectangle = 6u;  // a quad of perpendicular edges

struct KernelEmitter {
    vec3 origin;  // world; triangle, quad: a corner; disk, sphere: the centre
    uint kind;
    vec3 edge0;  // triangle, quad: edges from that corner; disk: conjugate semi-axes
    uint index;  // instance or light
    vec3 edge1;
    uint primitive;
    float probability;  // of being selected
    float cumulative;   // sum of the probabilities up to and including this one
    float area;         // m²; sphere: its world radius in metres if it stays a sphere there, else 0
    float orientation;  // −1 where the instance mirrors: the front is orientation · edge0 × edge1
    vec3 normal;        // unit, on the front side; sphere: unused
    uint light_node;    // its leaf in the light tree, or kernel_no_emitter: `probability` is all
    vec2 lengths;       // m, of the edges
};

/// A node of the tree over the emitters that stand somewhere: node 0 is the root, the children of each stand side by
/// side at odd and even places.
SHADING_CONST uint kernel_light_node_leaf = 1u;
SHADING_CONST uint kernel_light_node_two_sided = 2u;

struct KernelLightNode {
    vec3 bounds_min;  // m, world
    float intensity;  // cd, along the normals, of all its emitters together
    vec3 bounds_max;
    uint child;  // the first of two; leaf: the emitter
    vec3 axis;
    float cos_normals;   // of the half-angle about `axis` (two-sided: or −axis) within which all normals lie
    float cos_emission;  // of the angle to its normal beyond which no emitter shines
    uint parent;
    uint flags;  // kernel_light_node_…
    uint padding;
};

/// A direction to a selected emitter and what it brings, for next-event estimation.
struct KernelLightSample {
    vec3 direction;  // from the receiver, unit length
    float pdf;       // per steradian, of this direction by light sampling; 0 for lights without extent
    vec3 light;      // adds f · |cos θ| · light · visibility
    float distance;  // m, to `target` along `direction`; kernel_infinity for the sky and directional lights
    vec3 target;     // where the shadow ray ends, just in front of the emitter; only for finite distances
    uint emitter;    // that was selected
};

/// Where a ray met a surface, in the world, before its material is looked at.
struct KernelPoint {
    vec3 position;
    uint instance;
    vec3 error;  // bound on the rounding error of each coordinate, m
    uint material;
    vec3 geometric_normal;  // unit, on the front side
    uint primitive;
    vec3 normal;  // unit, interpolated, on the front side
    uint attributes;
    vec4 tangent;  // w = ±1: bitangent = w · cross(normal, tangent)
    vec4 color;
    vec2 texcoord0;
    vec2 texcoord1;
};

SHADING_CONST float kernel_infinity = 1.0e30f;
SHADING_CONST uint kernel_no_emitter = 0xffffffffu;

/// The picture, the camera and the tables' sizes: the same for every path of a render.
struct KernelFrame {
    vec3 camera_position;
    uint width;
    vec3 camera_forward;
    uint height;
    vec3 camera_right;  // scaled by the tangent of half the horizontal field of view
    uint max_depth;     // scattering events; 0 = unlimited
    vec3 camera_up;     // scaled by the tangent of half the vertical field of view
    uint seed;
    uint emitter_count;
    uint visible_light_count;  // lights with an extent: spheres and directional discs
    uint environment;          // 0: the sky is black
    uint sky_emitter;          // the place among the emitters of a sky that varies, or kernel_no_emitter
    uint sky_columns;          // of the sky's sampling table
    uint sky_rows;
    uint scattered_emission;  // 0: no scattered ray can meet any light, so the last one need not be traced
    uint sample_streams;      // independently scrambled sequences that a pixel's samples take turns in; at least 1
    uint distant_emitters;    // directional lights and the sky: first among the emitters, in no tree
    uint light_node_count;    // 0: emitters are selected by their `probability` alone
    uint tile_bits;           // pixels of squares of 2^tile_bits share a scrambling (kernel_tile_sampler.h); 0 to 4
    uint branch_bits;         // paths leave their first surface in 2^branch_bits directions; 0 to 2
};

// -- the path

SHADING_CONST uint kernel_stage_done = 0u;
SHADING_CONST uint kernel_stage_scatter = 1u;  // a scatter ray is next
SHADING_CONST uint kernel_stage_shadow = 2u;   // a shadow ray is next, then what `after_shadow` says

// A ray that crosses more translucent surfaces than this is caught between coinciding ones.
SHADING_CONST uint kernel_most_passes = 4096u;

/// A direction in which a path leaves its first surface, drawn but not yet followed.
struct PathBranch {
    vec3 direction;
    float scatter_pdf;  // per steradian, of any of the branches
    vec3 throughput;
    float eta_scale;
    vec3 absorption;  // of the solid that it enters, 1/m
    uint sample_reversed;
};

struct PathState {
    vec3 origin;  // of the next scatter ray
    uint stage;
    vec3 direction;
    uint after_shadow;  // the stage that follows the shadow ray
    vec3 throughput;
    float scatter_pdf;  // of `direction`, per steradian; 0: no light sampling competes with this ray
    vec3 scatter_origin;  // where the ray was scattered: `origin` moves on past translucent surfaces
    uint depth;           // scattering events so far
    vec3 shadow_origin;
    float shadow_t_max;
    vec3 shadow_direction;
    uint pass_count;  // translucent surfaces met so far
    vec3 shadow_light;  // arrives if nothing blocks the shadow ray
    uint pixel_seed;
    vec3 radiance;  // all light gathered
    uint sample_reversed;
    vec3 direct;  // the part of it scattered at most once
    float eta_scale;  // the part of the throughput that is radiance's 1/eta² across boundaries
    vec3 scatter_normal;  // at scatter_origin, as kernel_sample_emitters took it
    uint tile_seed;       // of the scrambling that the pixel shares with its tile
    uint place_reversed;  // the pixel's number in its tile, bit-reversed
    vec3 absorption;  // of the solid that the path is in, 1/m
    float roulette;   // a path survives with this times its weight, or at any rate from 1 on
    vec3 first_position;  // the surface that the branches leave, as kernel_scatter had it
    uint branches_left;
    vec3 first_error;
    uint branches_begun;
    vec3 first_geometric;
    float padding1;
    vec3 first_light_side;
    float padding2;
    PathBranch branch0;  // the next; a stack, without an array for the sake of translations that have none
    PathBranch branch1;
    PathBranch branch2;
    PathBranch branch3;
};

SHADING_END
#endif
