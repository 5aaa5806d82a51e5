// Picks some of very many lights, each with a chance in proportion to what it may give the place (light_grid.comp), and
// weighs it by the inverse of that chance: the mean is exact whatever the chances (Shirley, Wang & Zimmerman 1996,
// "Monte Carlo techniques for direct lighting calculations").
#ifndef HELIODON_LIGHT_CHOICE_GLSL
#define HELIODON_LIGHT_CHOICE_GLSL
#include "passes/light_grid/light_grid_shared.h"

layout(set = 0, binding = 24, std430) readonly buffer LightGrid { LightGridHeader light_grid; uint light_sums[]; };

/// Picks follow one another at even steps from a random start (systematic sampling): a light with a large share is
/// picked about as often as it deserves. Few lights are all picked, each once.
struct LightPicks {
    bool all;
    uint count;   // picks
    uint done;
    uint cell;
    uint total;
    float start;  // 0 … 1
};
struct LightPick {
    uint light;    // in the batch
    float weight;  // of its light
};

uint light_sum(uint light, uint cell) { return light_sums[light * light_grid.edge * light_grid.edge * light_grid.edge + cell]; }

/// All of a batch's `light_count` lights, or `count` picks where they are many.
LightPicks light_picks(vec3 position, uint light_count, uint count, float random) {
    LightPicks picks;
    picks.all = !has_many_lights || light_count <= most_lights_summed;
    picks.count = picks.all ? light_count : count;
    picks.done = 0u;
    picks.start = random;
    picks.cell = 0u;
    picks.total = 0u;
    if (picks.all) return picks;
    const ivec3 cell = clamp(ivec3(floor((position - light_grid.origin) / light_grid.cell_m)), ivec3(0), ivec3(light_grid.edge - 1u));
    picks.cell = uint(cell.x) + light_grid.edge * (uint(cell.y) + light_grid.edge * uint(cell.z));
    picks.total = light_sum(light_count - 1u, picks.cell);
    if (picks.total == 0u) picks.count = 0u;
    return picks;
}

uint pick_target(LightPicks picks, uint pick) {
    return min(uint((float(pick) + picks.start) / float(picks.count) * float(picks.total)), picks.total - 1u);
}

/// The next light, with all picks that fall on it; false when there is none.
bool next_light(inout LightPicks picks, out LightPick pick) {
    pick = LightPick(picks.done, 1.0f);
    if (picks.done >= picks.count) return false;
    if (picks.all) {
        ++picks.done;
        return true;
    }
    const uint target = pick_target(picks, picks.done);
    uint low = 0u;
    uint high = light_grid.light_count - 1u;
    while (low < high) {
        const uint middle = (low + high) / 2u;
        if (light_sum(middle, picks.cell) > target) high = middle;
        else low = middle + 1u;
    }
    const uint upper = light_sum(low, picks.cell);
    const uint lower = low > 0u ? light_sum(low - 1u, picks.cell) : 0u;
    uint uses = 1u;
    while (picks.done + uses < picks.count && pick_target(picks, picks.done + uses) < upper) ++uses;
    picks.done += uses;
    pick = LightPick(low, float(uses) * float(picks.total) / (float(picks.count) * float(upper - lower)));
    return true;
}

#endif
