// What the bidirectional kernel (bidirectional_kernel.h) keeps and hands over, in both languages.
#ifndef HELIODON_SHADING_BIDIRECTIONAL_STATE_H
#define HELIODON_SHADING_BIDIRECTIONAL_STATE_H
#include "shading/bsdf_lobes.h"
#include "shading/kernel_state.h"
SHADING_BEGIN

/// What the strategies that would make a subpath's vertices from the other side weigh, against the one that joins
/// two subpaths at its last vertex x: (pdf of x from the other side)² · (last + (pdf from x of the one before)² ·
/// before). Georgiev 2012, "Implementing Vertex Connection and Merging", d_VCM and d_VC without merging, each
/// squared for the power heuristic.
struct PartialWeights {
    float last;
    float before;
};

/// A scattering vertex of a subpath, as seen from the vertex before it.
struct SubpathVertex {
    vec3 position;
    uint two_sided;
    vec3 error;             // bound on the rounding error of each coordinate, m
    uint events;            // scattering events of its subpath up to and with this one
    vec3 geometric_normal;  // unit, on the front side
    uint solid;             // 1: behind it lies a transmissive solid's inside
    vec3 mapped_normal;  // unit, on the front side, after normal and bump maps
    vec3 toward;         // unit, to the vertex before, from whose side the three last members are
    vec3 throughput;
    PartialWeights weights;
    vec3 shading_normal;
    Surface surface;
    BsdfLobes lobes;
};

/// f · |cos θ| for radiance, and the density per steradian of the direction.
struct VertexScattering {
    vec3 value;
    float pdf;
};

/// Light that sets out from an emitter.
struct EmittedLight {
    vec3 origin;   // of its ray; just before the emitter's surface, or outside the scene
    uint emitter;  // place among the emitters, or kernel_constant_sky
    vec3 direction;
    float density;  // see kernel_emission_density
    vec3 position;  // surfaces: on the emitter, with its normal on the front side
    vec3 normal;
    vec3 light;  // radiance (of lights without extent: intensity in cd, illuminance in lux) / density
};

SHADING_CONST uint kernel_constant_sky = 0xfffffffeu;  // among the emitters that light subpaths start from
SHADING_CONST uint bidirectional_any = 0xffffffffu;
SHADING_CONST uint bidirectional_no_pixel = 0xffffffffu;

SHADING_CONST uint bidirectional_phase_light = 0u;
SHADING_CONST uint bidirectional_phase_camera = 1u;

struct BidirectionalState {
    PathState walk;          // the subpath under way: its ray or shadow ray, and the light gathered
    SubpathVertex vertex;    // where it stands
    PartialWeights weights;  // of the vertex that its ray will find, before distance and cosine are known
    EmittedLight emitted;    // how the light subpath began
    uint phase;
    uint pixel;
    uint sample_index;
    uint slot;               // names the light subpath to fetch_light_vertex and store_light_vertex
    uint light_vertices;     // so many are stored
    uint next_light_vertex;  // the next to be connected to
    uint shadow_events;      // scattering events of the path that the last shadow ray completes
    uint shadow_pixel;       // light subpath: where that ray's light falls
    uint splat_pixel;        // where light that has just reached the camera falls, or bidirectional_no_pixel
    vec3 splat_light;        // its part in that pixel's value for this sample of the whole picture
};

SHADING_END
#endif
