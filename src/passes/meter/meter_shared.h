#ifndef HELIODON_PASSES_METER_SHARED_H
#define HELIODON_PASSES_METER_SHARED_H
#include "shading/metering.h"
SHADING_BEGIN

SHADING_CONST uint exposure_by_camera = 0u;
SHADING_CONST uint exposure_metered = 1u;
SHADING_CONST uint exposure_by_key = 2u;

struct MeterConstants {
    uint width;
    uint height;
    float sample_scale;  // 1 / samples in the sum
    uint pattern;        // metering_*
};

struct ExposeConstants {
    uint mode;              // exposure_*
    float camera_ev100;
    float compensation_ev;  // stops brighter
    uint pattern;           // metering_*
    uint arithmetic;        // 1: the mean of luminance, 0: of its logarithm
    float low_percentile;
    float high_percentile;
    uint estimate_white;    // 1: the white follows from the picture
    float white;
    uint adapts;            // 0: at once
    float seconds;          // since the frame before
    float to_light_s;
    float to_dark_s;
};

/// What exposes the picture; kept from frame to frame.
struct ExposureState {
    float ev100;
    float white;    // the exposed value that becomes white
    uint started;   // 0: nothing to adapt from
    float wanted;   // EV100 that it adapts to
};

SHADING_END
#endif
