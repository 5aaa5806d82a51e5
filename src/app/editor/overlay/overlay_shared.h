// Push constants of the overlay, for C++ and GLSL.
#ifndef HELIODON_OVERLAY_SHARED_H
#define HELIODON_OVERLAY_SHARED_H
#include "shading/language.h"
SHADING_BEGIN

/// clip = position · scale + shift; position in pixels from the window's top left.
struct OverlayPush {
    vec2 scale;
    vec2 shift;
    uint texture_slot;
};

SHADING_END
#endif
