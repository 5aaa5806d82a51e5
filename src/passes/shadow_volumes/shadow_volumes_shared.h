// Shadow volumes behind the triangles that the sun lights, in C++ and GLSL.
#ifndef HELIODON_PASSES_SHADOW_VOLUMES_SHARED_H
#define HELIODON_PASSES_SHADOW_VOLUMES_SHARED_H
#include "shading/language.h"
SHADING_BEGIN

/// One instance that casts shadows. Triangles and edges of all of them are numbered one instance after another.
struct CasterRange {
    uint first_triangle;
    uint first_edge;
    uint instance;
    uint edge_table;  // where its geometry's edges begin among CasterEdge
};

/// Two vertices of a geometry, one for all at their positions, and the triangles between them.
struct CasterEdge {
    uint a;
    uint b;
    uint first_use;  // each: the geometry's triangle · 2, + 1 where it goes round from b to a
    uint use_count;
};

// What is known of a triangle.
SHADING_CONST uint caster_lit = 1u;
SHADING_CONST uint caster_toward = 2u;       // its corners go round counter-clockwise as the sun sees them …
SHADING_CONST uint caster_away = 4u;         // … or clockwise; neither: on edge, or without area
SHADING_CONST uint caster_significant = 8u;  // it is looked for until it is found
SHADING_CONST uint caster_rear = 16u;        // of a closed mesh, and averted from the sun: never lit
SHADING_CONST uint caster_joined = 32u;      // not lit, but with a volume of its own there are fewer silhouettes

struct ClassifyConstants {
    vec3 sun;  // unit, the way its light travels
    float significant_m2;
    uint range_count;
    uint triangle_count;
};

/// One part of the map of lit triangles, as the sun sees it: an orthographic view of size² texels with reversed depth.
struct LitMapConstants {
    mat4 world_to_clip;
    uint range_count;
    uint triangle_count;
    uint size;
    float depth_a_texel;  // change of depth over a texel's width
    uint child_x;         // the first of its quarters in the grid of parts of the next round
    uint child_y;
    uint child_row;
    uint last_round;
};

/// First words of what a round finds out; the parts of the next round follow, row after row: 1 where one is wanted.
struct LitMapHeader {
    uint found;  // significant triangles that were not known to be lit
    uint padding0;
    uint padding1;
    uint padding2;
};

// A triangle of fewer texels may lie between their centres, as may one narrower than a texel.
SHADING_CONST float lit_map_seen_texels = 4.0f;

struct SilhouetteConstants {
    uint range_count;
    uint count;     // triangles or edges
    uint capacity;
    uint choice;    // behind_…
};
// Which triangles of an instance have volumes: the lit ones, these and joined ones, all that face the sun, or those of
// these three with the fewest sides.
SHADING_CONST uint behind_lit = 0u;
SHADING_CONST uint behind_joined = 1u;
SHADING_CONST uint behind_all = 2u;
SHADING_CONST uint behind_fewest = 3u;

/// Of an instance: the sides of its volumes, by that choice.
struct CasterTally {
    uint lit;
    uint joined;
    uint all;
    uint padding;
};

/// VkDrawIndirectCommand
struct VolumeDraw {
    uint vertex_count;
    uint instance_count;
    uint first_vertex;
    uint first_instance;
};
SHADING_CONST uint volume_draw_sides = 0u;   // silhouettes
SHADING_CONST uint volume_draw_toward = 1u;  // caps, by how their corners go round
SHADING_CONST uint volume_draw_away = 2u;
SHADING_CONST uint volume_draws = 3u;
SHADING_CONST uint volume_edges = 3u;  // drawn by nobody: counts the edges that sides start from

struct VolumeConstants {
    mat4 world_to_clip;  // of the picture's sample, without far plane
    vec3 sun;
    uint first;          // cap
};

SHADING_END
#endif
