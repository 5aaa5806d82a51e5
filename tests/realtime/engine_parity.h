#pragma once

#include "core/metrics.h"
#include "test_scenes.h"
#include "trace/path_tracer.h"

namespace heliodon::tests {

/// Direct light of both engines through the scene's first camera, a small form of the published comparison
/// (512² there).
class EngineParity : public RealtimeTest {
protected:
    struct Effort {
        int size = 128;
        int realtime_samples = 64;
        int path_samples = 64;
        int height = 0;  // 0: square
    };
    struct Limits {
        double median, relmse, flip;
    };
    struct Pictures {
        Picture realtime, path;
    };

    Pictures render_both(const Scene& scene, const Effort& effort) {
        Camera camera;
        scene.cameras().each([&](CameraId, const Camera& first) { camera = first; });
        RealtimeOptions options;
        options.width = effort.size;
        options.height = effort.height ? effort.height : effort.size;
        options.samples = effort.realtime_samples;
        options.environment = false;
        Picture picture = render(scene, camera, options);
        PathTracer tracer;
        const auto updated = tracer.update(scene);
        if (!updated) ADD_FAILURE() << updated.error().text();
        PathOptions path;
        path.width = options.width;
        path.height = options.height;
        path.samples_per_pixel = effort.path_samples;
        path.max_depth = 1;
        path.environment = false;
        auto reference = tracer.render(scene, camera, path);
        if (!reference) {
            ADD_FAILURE() << reference.error().text();
            return {picture, picture};
        }
        save(*reference);
        return {std::move(picture), std::move(*reference)};
    }
    Pictures expect_agreement(const Scene& scene, const Effort& effort, const Limits& limits) {
        Pictures pictures = render_both(scene, effort);
        const auto metrics = compare(pictures.path.image, pictures.realtime.image, pictures.path.ev100);
        if (!metrics) {
            ADD_FAILURE() << metrics.error().text();
            return pictures;
        }
        EXPECT_LE(metrics->median_relative, limits.median);
        EXPECT_LE(metrics->relmse, limits.relmse);
        EXPECT_LE(metrics->flip, limits.flip);
        RecordProperty("median_relative", std::to_string(metrics->median_relative));
        RecordProperty("relmse", std::to_string(metrics->relmse));
        RecordProperty("flip", std::to_string(metrics->flip));
        return pictures;
    }
};

}  // namespace heliodon::tests
