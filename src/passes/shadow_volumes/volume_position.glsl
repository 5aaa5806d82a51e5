// Where a vertex stands in the picture: the same bits in every shader, so that the caps of volumes lie exactly in the
// surfaces that the depth was drawn from.
#ifndef HELIODON_VOLUME_POSITION_GLSL
#define HELIODON_VOLUME_POSITION_GLSL
#include "passes/common/scene_tables.glsl"
#include "passes/shadow_volumes/shadow_volumes_shared.h"

layout(push_constant) uniform Push { VolumeConstants push; };
out gl_PerVertex {
    invariant vec4 gl_Position;
};

vec4 volume_position(uint instance_index, uint vertex) {
    const InstanceData instance = instance_table[instance_index];
    const vec3 position = fetch_vec3(geometry_table[instance.geometry].position_offset, vertex);
    precise vec4 world = instance.object_to_world * vec4(position, 1.0f);
    precise vec4 clip = push.world_to_clip * vec4(world.xyz, 1.0f);
    return clip;
}

#endif
