// A fragment's triangle, and the part of it in the fragment's column of voxels.
#ifndef HELIODON_VOXEL_COLUMN_GLSL
#define HELIODON_VOXEL_COLUMN_GLSL
#include "passes/voxelize/voxel_triangle.glsl"

layout(location = 0) flat in uvec2 triangle_of;  // instance, primitive
layout(location = 1) flat in vec3 corner0;
layout(location = 2) flat in vec3 corner1;
layout(location = 3) flat in vec3 corner2;

bool column_of_fragment(out VoxelTriangle triangle) {
    const InstanceData instance = instance_table[triangle_of.x];
    triangle.instance = triangle_of.x;
    triangle.primitive = triangle_of.y;
    const uint first = geometry_table[instance.geometry].first_index + 3u * triangle_of.y;
    triangle.index = uvec3(index_table[first], index_table[first + 1u], index_table[first + 2u]);
    return triangle_in_grid(corner0, corner1, corner2, instance.determinant_sign, triangle) &&
           narrow_to_column(triangle, ivec2(gl_FragCoord.xy));
}

#endif
