// The filtered voxel volume that cones are traced through, in C++ and GLSL.
#ifndef HELIODON_PASSES_VOLUME_SHARED_H
#define HELIODON_PASSES_VOLUME_SHARED_H
#include "passes/voxelize/voxel_shared.h"
SHADING_BEGIN

/// Cascade c has voxels of voxel_m · 2^c, and its corner lies `base` of them from the lattice's origin, so that each
/// voxel of one cascade is two by two by two voxels of the one within it. Its level m are its voxels filtered m times.
struct VolumeCascade {
    ivec3 base;
    uint padding;
};

/// All faces of all cascades lie in one 3D texture of 2 n × cascades n × 3 n texels: the face of axis a (x y z) that
/// looks to the positive (s = 0) or negative side (s = 1) of cascade c begins at (s n, c n, a n). Beside radiance × cover
/// and cover (RGBA) a second texture, alike, has depth × cover: where in its layer, 0 … 1, the face stands.
/// A third, from level 1 on and so half as large, has what faces send ahead of lights (passes/inject/face_lobe.glsl): × cover,
/// the light with cover, and as far again along z the direction with its weight.
struct VolumeData {
    vec3 lattice;         // world position of the lattice's origin
    float voxel_m;        // edge of the finest voxels
    uint size;            // voxels an edge of a cascade, n
    uint cascades;
    float radiance_unit;  // cd/m² that 1 in the texture stands for
    uint sky_enabled;
    uint effects;         // gi_effect_…
    uint cone_sets;       // of nine cones, for a pixel
    uint gather_sets;     // of nine cones, for a voxel's face
    uint isotropic;       // 1: a voxel shows one value to all sides
    VolumeCascade cascade[8];
};

SHADING_CONST uint gi_effect_diffuse = 1u;
SHADING_CONST uint gi_effect_specular = 2u;
SHADING_CONST uint gi_effect_refraction = 4u;
SHADING_CONST uint gi_effect_shadows = 8u;
SHADING_CONST uint gi_effect_occlusion = 16u;

SHADING_END
#endif
