#ifndef HELIODON_PASSES_INJECT_SHARED_H
#define HELIODON_PASSES_INJECT_SHARED_H
#include "passes/cone_trace/volume_shared.h"
SHADING_BEGIN

/// Work on the records of one cascade.
struct InjectConstants {
    VoxelGrid grid;
    uint cascade;
    uint light_first;
    uint light_count;
    uint add;  // 1: further lights, added to those before
    vec2 gather_shift;   // of diffuse_cone()
    float gather_weight; // of what is gathered now against what was before
    uint face;           // which of the six faces of the listed records, where a pass takes one of them
    ivec3 shift;         // voxel v of this grid was voxel v + shift of the one whose gathered light is kept
    uint unlit_only;     // gather: for faces alone that have not gathered yet
    float gather_share;  // of diffuse_cone()
};

/// First words of the lists of faces that light can leave: of each of the six faces, VkDispatchIndirectCommand, and
/// in w how many records are listed. The lists follow, room for VoxelHeader.record_count in each.
struct LitFacesHeader {
    uvec4 groups[6];         // of 64 invocations, one a face
    uvec4 gather_groups[6];  // of gather_faces_a_group faces
    uvec4 workgroups_done;   // x: of those that make the lists
};
SHADING_CONST uint gather_faces_a_group = 32u;
SHADING_CONST uint lit_record_enclosed = 0x80000000u;  // beside the record: solids enclose the face

/// Work on the occupied voxels of one level of the last cascade.
struct FilterConstants {
    uint level;      // being written or cleared
    uint size;       // voxels an edge of the cascade, level 0
    uint cascade;
    uint list_first; // of the level's voxels, in words
};

SHADING_END
#endif
