// A fragment's triangle, and the part of it in the fragment's column of voxels.
#ifndef HELIODON_VOXEL_COLUMN_GLSL
#define HELIODON_VOXEL_COLUMN_GLSL
#include "passes/voxelize/voxel_triangle.glsl"

layout(location = 0) flat in uvec2 triangle_of;  // instance, primitive
layout(location = 1) flat in vec3 corner0;
layout(location = 2) flat in vec3 corner1;
layout(location = 3) flat in vec3 corner2;

bool column_of_fragment(out VoxelTriangle triangle) {
    triangle.instance = triangle_of.x;
    triangle.primitive = triangle_of.y;
    return triangle_in_grid(corner0, corner1, corner2, instance_table[triangle_of.x].determinant_sign, triangle) &&
           narrow_to_column(triangle, ivec2(gl_FragCoord.xy));
}

#endif
