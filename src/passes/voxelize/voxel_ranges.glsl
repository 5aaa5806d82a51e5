// Which instance a triangle belongs to, of all triangles to be voxelized.
#ifndef HELIODON_VOXEL_RANGES_GLSL
#define HELIODON_VOXEL_RANGES_GLSL

struct TriangleRange {
    uint first_triangle;  // triangles of the ranges before
    uint instance;
};
layout(set = 0, binding = 12, std430) readonly buffer Ranges { TriangleRange ranges[]; };

TriangleRange range_of(uint triangle, uint range_count) {
    uint low = 0u;
    uint high = range_count;
    while (high - low > 1u) {
        const uint middle = (low + high) / 2u;
        if (ranges[middle].first_triangle <= triangle) low = middle;
        else high = middle;
    }
    return ranges[low];
}

#endif
