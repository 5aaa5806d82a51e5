// The intensities of luminaires, and with them what any light sends.
#ifndef HELIODON_LUMINAIRES_GLSL
#define HELIODON_LUMINAIRES_GLSL
#include "shading/luminaire_shape.h"

layout(set = 0, binding = 26, std430) readonly buffer LuminaireTable { float luminaire_table[]; };
float luminaire_value(uint i) { return luminaire_table[i]; }

#include "shading/luminaire.h"

#endif
