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
/// Its place and shape alone, and which of its lobes give any light.
struct ConePlace {
    float depth_m;
    vec3 geometric;
    vec3 normal;
    float alpha;
    float coat_alpha;
    bool rough;   // it has a diffuse lobe
    bool glossy;  // a specular one
    bool coated;
    bool transmissive;
};
struct PackedSurface {
    uvec4 place;
    uvec4 albedos;
    uint lobes;
};

uint pack_direction(vec3 v) { return packSnorm2x16(octahedral_encode(v)); }
vec3 unpack_direction(uint word) { return octahedral_decode(unpackSnorm2x16(word)); }

// Half floats up to 1 leave their two highest bits.
const uint rough_bit = 0x4000u, glossy_bit = 0x8000u, coated_bit = 0x40000000u, transmissive_bit = 0x80000000u;
const uint lobe_bits = 0xc000c000u;

PackedSurface pack_surface(ConeSurface s) {
    const ConeLobes a = s.albedo;
    PackedSurface p;
    uint shape = packHalf2x16(min(vec2(s.alpha, s.coat_alpha), 1.0f));
    if (a.diffuse != vec3(0.0f)) shape |= rough_bit;
    if (a.specular != vec3(0.0f)) shape |= glossy_bit;
    if (a.coat != vec3(0.0f)) shape |= coated_bit;
    if (a.refraction != vec3(0.0f)) shape |= transmissive_bit;
    p.place = uvec4(floatBitsToUint(s.depth_m), pack_direction(s.geometric), pack_direction(s.normal), shape);
    p.albedos = uvec4(packHalf2x16(a.diffuse.xy), packHalf2x16(vec2(a.diffuse.z, a.specular.x)), packHalf2x16(a.specular.yz),
                      packHalf2x16(a.refraction.xy));
    p.lobes = packHalf2x16(vec2(a.refraction.z, a.coat.x));
    return p;
}
ConePlace unpack_place(uvec4 place) {
    ConePlace p;
    p.depth_m = uintBitsToFloat(place.x);
    p.geometric = unpack_direction(place.y);
    p.normal = unpack_direction(place.z);
    const vec2 alphas = unpackHalf2x16(place.w & ~lobe_bits);
    p.alpha = alphas.x;
    p.coat_alpha = alphas.y;
    const bool there = p.depth_m > 0.0f;
    p.rough = there && (place.w & rough_bit) != 0u;
    p.glossy = there && (place.w & glossy_bit) != 0u;
    p.coated = there && (place.w & coated_bit) != 0u;
    p.transmissive = there && (place.w & transmissive_bit) != 0u;
    return p;
}
ConeLobes unpack_lobes(uvec4 albedos, uint lobes) {
    const vec2 middle = unpackHalf2x16(albedos.y);
    const vec2 last = unpackHalf2x16(lobes);
    return ConeLobes(vec3(unpackHalf2x16(albedos.x), middle.x), vec3(middle.y, unpackHalf2x16(albedos.z)), vec3(last.y),
                     vec3(unpackHalf2x16(albedos.w), last.x));
}

#endif
