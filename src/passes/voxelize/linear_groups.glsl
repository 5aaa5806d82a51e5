// Workgroups and invocations counted along the rows of a dispatch that was spread over x and y.
#ifndef HELIODON_LINEAR_GROUPS_GLSL
#define HELIODON_LINEAR_GROUPS_GLSL
#include "passes/voxelize/voxel_shared.h"

/// Arguments of a dispatch of at least `groups` workgroups; the last row is full, so shaders check their index.
uvec4 spread_groups(uint groups) { return uvec4(min(groups, groups_a_row), (groups + groups_a_row - 1u) / groups_a_row, 1u, 0u); }
uint linear_group() { return gl_WorkGroupID.x + groups_a_row * gl_WorkGroupID.y; }
/// Of workgroups of 64 along x.
uint linear_invocation() { return linear_group() * 64u + gl_LocalInvocationID.x; }

#endif
