#pragma once

/// Everything that a program needs to load or build a scene, render it with either engine, measure it and
/// compare pictures. No Vulkan and no user interface here; whoever writes render passes includes
/// `graph/graph.h`, `graph/executor.h` and the `gpu/` headers besides (examples/custom_pass).

#include "core/image.h"
#include "core/image_io.h"
#include "core/metrics.h"
#include "core/progress.h"
#include "core/result.h"
#include "import/import.h"
#include "realtime/renderer.h"
#include "scene/scene.h"
#include "scene/scene_file.h"
#include "scene/sensor_reading.h"
#include "trace/path_tracer.h"
