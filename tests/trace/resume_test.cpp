// Going on from a picture that was stopped: to the same bits as without the stop, and from no other picture.
#include <unistd.h>
#include <filesystem>

#include "core/image_io.h"
#include "scene_building.h"

namespace heliodon::tests {
namespace {

const Camera& camera() {
    static const Camera made = looking({0, 1, 3.4f}, {0, 1, 0});
    return made;
}

PathOptions options_of(int samples) {
    PathOptions options;
    options.width = 21;
    options.height = 13;
    options.samples_per_pixel = samples;
    options.keep_state = KeepState::always;
    return options;
}

/// What is left of a picture after it was written and read.
Picture through_file(const Picture& picture) {
    const auto path = std::filesystem::temp_directory_path() / ("heliodon-resume-" + std::to_string(getpid()) + ".exr");
    EXPECT_TRUE(write_picture(path, picture));
    auto read = read_picture(path);
    std::filesystem::remove(path);
    EXPECT_TRUE(read) << (read ? "" : read.error().text());
    return read ? *read : Picture{};
}

Result<Picture> go_on(const Scene& scene, PathOptions options, const Picture& from) {
    PathTracer tracer;
    EXPECT_TRUE(tracer.update(scene));
    options.resume = &from;
    options.resume_name = "stopped.exr";
    return tracer.render(scene, camera(), options);
}

const Image& layer(const Picture& picture, const std::string& name) {
    static const Image none;
    for (const Layer& each : picture.layers)
        if (each.name == name) return each.image;
    ADD_FAILURE() << "no layer " << name;
    return none;
}

TEST(Resume, SomeSamplesAndThenMoreAreTheSameBitsAsAllAtOnce) {
    const Scene scene = small_room();
    PathOptions options = options_of(16);
    for (const bool variance : {false, true}) {
        if (variance) options.aovs = {"direct", "variance", "samples", "illuminance"};
        const Picture at_once = render(scene, camera(), options);
        for (const int first : {1, 7, 8, 16}) {
            PathOptions part = options;
            part.samples_per_pixel = first;
            const auto resumed = go_on(scene, options, through_file(render(scene, camera(), part)));
            ASSERT_TRUE(resumed) << resumed.error().text();
            EXPECT_EQ(resumed->image.pixels, at_once.image.pixels) << first;
            EXPECT_EQ(resumed->attributes, at_once.attributes);
            ASSERT_EQ(resumed->layers.size(), at_once.layers.size());
            for (std::size_t i = 0; i < at_once.layers.size(); ++i)
                EXPECT_EQ(resumed->layers[i].image.pixels, at_once.layers[i].image.pixels) << at_once.layers[i].name;
        }
    }
}

TEST(Resume, IlluminanceIsStoppedWithThePictureAndItsRaysCount) {
    const Scene scene = small_room();
    PathOptions options = options_of(1 << 20);
    options.seconds = 1000;  // short passes
    options.aovs = {"illuminance"};
    PathTracer tracer;
    ASSERT_TRUE(tracer.update(scene));
    PathStatistics stopped, all, without;
    const auto part = tracer.render(scene, camera(), options, &stopped, [](double) { return false; });
    ASSERT_TRUE(part);
    EXPECT_TRUE(stopped.stopped);
    ASSERT_LT(stopped.samples_per_pixel, 1000);
    options = options_of(stopped.samples_per_pixel);
    ASSERT_TRUE(tracer.render(scene, camera(), options, &without));
    options.aovs = {"illuminance"};
    const auto whole = tracer.render(scene, camera(), options, &all);
    ASSERT_TRUE(whole);
    EXPECT_EQ(layer(*part, "illuminance").pixels, layer(*whole, "illuminance").pixels);
    EXPECT_GT(layer(*part, "illuminance").at(10, 6), 0);
    EXPECT_EQ(stopped.rays, all.rays);
    EXPECT_GT(all.rays, 3 * without.rays / 2);
}

TEST(Resume, AStoppedAdaptiveRenderEndsAsIfItHadNotBeenStopped) {
    const Scene scene = small_room();
    PathOptions options = options_of(600);
    options.target_error = 0.3;
    options.max_depth = 2;
    options.keep_state = KeepState::when_stopped;
    options.aovs = {"variance", "samples"};
    const Picture at_once = render(scene, camera(), options);
    EXPECT_EQ(at_once.layers.size(), 2u) << "it was not stopped: no state";
    for (const int first : {5, 40, 100}) {
        PathOptions part = options;
        part.samples_per_pixel = first;
        part.keep_state = KeepState::always;
        const auto resumed = go_on(scene, options, through_file(render(scene, camera(), part)));
        ASSERT_TRUE(resumed) << resumed.error().text();
        EXPECT_EQ(resumed->image.pixels, at_once.image.pixels) << first;
        EXPECT_EQ(layer(*resumed, "variance").pixels, layer(at_once, "variance").pixels) << first;
        EXPECT_EQ(layer(*resumed, "samples").pixels, layer(at_once, "samples").pixels) << first;
    }
}

TEST(Resume, WorkThatIsAskedToStopGivesThePictureSoFarWithItsState) {
    const Scene scene = small_room();
    PathTracer tracer;
    ASSERT_TRUE(tracer.update(scene));
    PathOptions options = options_of(most_samples_per_pixel);
    options.keep_state = KeepState::when_stopped;
    PathStatistics statistics;
    int calls = 0;
    const auto stopped = tracer.render(scene, camera(), options, &statistics, [&](double) { return ++calls < 3; });
    ASSERT_TRUE(stopped);
    EXPECT_TRUE(statistics.stopped);
    EXPECT_EQ(calls, 3);
    ASSERT_TRUE(stopped->attributes.contains("resume.samples"));
    EXPECT_EQ(stopped->attributes.at("resume.samples"), std::to_string(statistics.samples_per_pixel));
    const Picture plain = render(scene, camera(), options_of(statistics.samples_per_pixel));
    EXPECT_EQ(stopped->image.pixels, plain.image.pixels);
}

TEST(Resume, FromAnotherPictureIsOneErrorThatSaysWhatDiffers) {
    const Scene scene = small_room();
    const Picture from = through_file(render(scene, camera(), options_of(4)));
    const auto refused = [&](const char* what, const Scene& other, const PathOptions& options, const Picture& picture) {
        const auto result = go_on(other, options, picture);
        ASSERT_FALSE(result) << what;
        EXPECT_EQ(result.error().where, "stopped.exr");
        EXPECT_NE(result.error().message.find(what), std::string::npos) << result.error().message;
    };
    PathOptions options = options_of(8);
    EXPECT_TRUE(go_on(scene, options, from));
    options.seed = 5;
    refused("another seed: expected 5, found 0", scene, options, from);
    options = options_of(8);
    options.width = 22;
    refused("another size: expected 22x13, found 21x13", scene, options, from);
    options = options_of(8);
    options.max_depth = 3;
    refused("another max-depth", scene, options, from);
    options = options_of(8);
    options.target_error = 0.1;
    refused("another target-error", scene, options, from);
    options = options_of(8);
    options.aovs = {"direct"};
    refused("resume.direct0.high", scene, options, from);
    refused("at most 2 samples", scene, options_of(2), from);
    Scene brighter = small_room();
    add_light(brighter, point_light(1), {0, 1, 0});
    refused("another scene", brighter, options_of(8), from);
    Picture plain = from;
    plain.attributes.clear();
    refused("its state is not in this one", scene, options_of(8), plain);
    Picture damaged = from;
    damaged.attributes["resume.samples"] = "many";
    refused("'many'", scene, options_of(8), damaged);
    damaged = from;
    damaged.layers.pop_back();
    refused("expected a layer resume.radiance0.", scene, options_of(8), damaged);
}

}  // namespace
}  // namespace heliodon::tests
