// A voxel that shows all sides the same (Crassin, Neyret, Sainz, Green & Eisemann 2011, section 4.1), from what each of
// its sides would show.
#ifndef HELIODON_ISOTROPIC_GLSL
#define HELIODON_ISOTROPIC_GLSL

/// Radiance × cover and cover. `shining`: the sum over the sides, so that the radiance is their mean weighted by cover.
/// `cover`: that of the side that covers most: with any mean of sides a wall would let light through.
vec4 isotropic_value(vec4 shining, float cover) {
    return vec4(shining.a > 0.0f ? shining.rgb * (cover / shining.a) : vec3(0.0f), cover);
}

#endif
