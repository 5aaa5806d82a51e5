// Panes of no thickness (the thin model): what passes straight on.
#ifndef HELIODON_SHADING_PANE_H
#define HELIODON_SHADING_PANE_H
#include "shading/scene_data.h"
SHADING_BEGIN

/// Share of the light that a thin pane lets pass straight on, by the cosine of incidence on either side.
SHADING_FN float thin_transmittance(SHADING_IN(MaterialData) m, float cosine) {
    float c = min(abs(cosine), 1.0f);
    vec4 low = m.transmittance;
    vec2 high = m.transmittance_high;
    return clamp(low.x + c * (low.y + c * (low.z + c * (low.w + c * (high.x + c * high.y)))), 0.0f, 1.0f);
}

SHADING_END
#endif
