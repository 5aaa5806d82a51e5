// Diffuse light of every second pixel, there and back. A sample is known by its pixel's normal and depth.
#ifndef HELIODON_HALF_RESOLUTION_GLSL
#define HELIODON_HALF_RESOLUTION_GLSL

const vec4 not_known = vec4(0.0f, 0.0f, 0.0f, -1.0f);

/// Which pixel of each two by two is traced; over the samples of a picture all of them.
ivec2 traced_pixel(uint sample_index) { return ivec2(int(sample_index & 1u), int((sample_index ^ (sample_index >> 1u)) & 1u)); }

/// How alike the light of two points is: 1 − ε with the error ε of Ward & Heckbert 1992 ("Irradiance Gradients", eq. 1),
/// for whose distance R to other surfaces a voxel's edge stands, below which the volume knows no detail. Distance
/// along the surface is left to the interpolation between pixels.
float likeness(vec3 normal, vec3 offset, vec3 other_normal, float voxel_m) {
    return max(0.0f, 1.0f - abs(dot(normal, offset)) / voxel_m - sqrt(max(0.0f, 1.0f - dot(normal, other_normal))));
}

#endif
