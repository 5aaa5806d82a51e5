// What a pixel's cones need to know of the surface that it shows; shading leaves it in three images.
#ifndef HELIODON_CONE_SURFACE_GLSL
#define HELIODON_CONE_SURFACE_GLSL
#include "passes/cone_trace/cone_lobes.glsl"
#include "shading/octahedral.h"

struct ConeSurface {
    float depth_m;  // along the view; 0: nothing
    vec3 geometric;
    vec3 normal;
    float alpha;
    float coat_alpha;
    ConeLobes albedo;  // its coat's is grey
};
struct PackedSurface {
    uvec4 place;
    uvec4 albedos;
    uint lobes;
};

uint pack_direction(vec3 v) { return packSnorm2x16(octahedral_encode(v)); }
vec3 unpack_direction(uint word) { return octahedral_decode(unpackSnorm2x16(word)); }

PackedSurface pack_surface(ConeSurface s) {
    const ConeLobes a = s.albedo;
    PackedSurface p;
    p.place = uvec4(floatBitsToUint(s.depth_m), pack_direction(s.geometric), pack_direction(s.normal), packHalf2x16(vec2(s.alpha, s.coat_alpha)));
    p.albedos = uvec4(packHalf2x16(a.diffuse.xy), packHalf2x16(vec2(a.diffuse.z, a.specular.x)), packHalf2x16(a.specular.yz),
                      packHalf2x16(a.refraction.xy));
    p.lobes = packHalf2x16(vec2(a.refraction.z, a.coat.x));
    return p;
}
ConeSurface unpack_surface(PackedSurface p) {
    ConeSurface s;
    s.depth_m = uintBitsToFloat(p.place.x);
    s.geometric = unpack_direction(p.place.y);
    s.normal = unpack_direction(p.place.z);
    const vec2 alphas = unpackHalf2x16(p.place.w);
    s.alpha = alphas.x;
    s.coat_alpha = alphas.y;
    const vec2 middle = unpackHalf2x16(p.albedos.y);
    const vec2 last = unpackHalf2x16(p.lobes);
    s.albedo.diffuse = vec3(unpackHalf2x16(p.albedos.x), middle.x);
    s.albedo.specular = vec3(middle.y, unpackHalf2x16(p.albedos.z));
    s.albedo.coat = vec3(last.y);
    s.albedo.refraction = vec3(unpackHalf2x16(p.albedos.w), last.x);
    return s;
}

#endif
