// Paths that leave their first surface in several directions: the same picture, with less error for its rays.
#include <numeric>

#include "picture_means.h"
#include "trace/branching.h"

namespace heliodon::tests {
namespace {

PathOptions branching_in(int branches, int size, int samples) {
    PathOptions options = pictures_of(size, samples, Integrator::path);
    options.branches = branches;
    return options;
}

void expect_the_same_mean(const std::string& name, const Scene& scene) {
    const PartMeans one = means_of(scene, into_box(), branching_in(1, 16, 8));
    for (const int branches : {2, 4})
        expect_equal_means(name + ", " + std::to_string(branches), one, means_of(scene, into_box(), branching_in(branches, 16, 4)));
}

TEST(Branching, KeepsTheMeanWithEveryLightAndMaterial) {
    Scene lamp = box_scene();
    add_shape(lamp, Quad{{-.4f, 1.95f, -.4f}, {.8f, 0, 0}, {0, 0, .8f}}, lambert(.2f, 200));
    expect_the_same_mean("a lamp that rays meet too", lamp);
    Scene sun_and_sky = box_scene(false);
    sun_and_sky.set_sky(even_sky(50));
    Light sun;
    sun.type = LightType::directional;
    sun.intensity = glm::vec3(300);
    sun.direction = glm::normalize(glm::vec3(.2f, -.6f, -1));
    add_light(sun_and_sky, sun, {0, 0, 0});
    expect_the_same_mean("sun and sky", sun_and_sky);
    Scene ball = box_scene();
    add_light(ball, point_light(50, .3f), {.3f, 1.4f, .6f});
    expect_the_same_mean("a ball of light that is no surface", ball);
    Scene veiled = box_scene(false);
    Material veil = lambert(.6f, 0, true);
    veil.alpha_mode = AlphaMode::blend;
    veil.opacity = .4f;
    add_shape(veiled, Quad{{-.8f, .1f, .7f}, {1.6f, 0, 0}, {0, 1.5f, 0}}, veil);
    Material solid = rough_glass();
    solid.attenuation_color = {.5f, .8f, .6f};
    solid.attenuation_distance_m = .3f;
    solid.thin_walled = false;
    add_shape(veiled, Sphere{{.4f, .45f, .2f}, .4f}, solid);
    add_shape(veiled, Quad{{-.4f, 1.95f, -.4f}, {.8f, 0, 0}, {0, 0, .8f}}, lambert(.2f, 200));
    expect_the_same_mean("a veil before an absorbing solid", veiled);
}

Scene cornell_like() {
    Scene scene = box_scene(false);
    add_shape(scene, Quad{{1, 0, -1}, {0, 0, 2}, {0, 2, 0}}, lambert(.6f));
    add_shape(scene, Quad{{-.25f, 1.99f, -.25f}, {.5f, 0, 0}, {0, 0, .5f}}, lambert(0, 1000));
    return scene;
}

/// Variance of the indirect light's pixels between pictures × rays of one.
double variance_times_rays(const Scene& scene, int branches) {
    PathTracer tracer;
    EXPECT_TRUE(tracer.update(scene));
    PathOptions options = branching_in(branches, 32, 16);
    options.aovs = {"indirect"};
    constexpr int pictures = 8;
    std::vector<double> sum, squares;
    std::uint64_t rays = 0;
    for (int i = 0; i < pictures; ++i) {
        options.seed = static_cast<std::uint32_t>(i);
        PathStatistics statistics;
        const auto picture = tracer.render(scene, into_box(), options, &statistics);
        EXPECT_TRUE(picture);
        rays += statistics.rays;
        const std::vector<float>& pixels = picture->layers[0].image.pixels;
        sum.resize(pixels.size()), squares.resize(pixels.size());
        for (std::size_t k = 0; k < pixels.size(); ++k) sum[k] += pixels[k], squares[k] += double(pixels[k]) * pixels[k];
    }
    double variance = 0;
    for (std::size_t k = 0; k < sum.size(); ++k) variance += squares[k] / pictures - (sum[k] / pictures) * (sum[k] / pictures);
    return variance * static_cast<double>(rays);
}

TEST(Branching, TakesLessRaysToTheSameErrorWhereLightComesOffWalls) {
    const Scene scene = cornell_like();
    const double one = variance_times_rays(scene, 1), four = variance_times_rays(scene, 4);
    RecordProperty("four_to_one", std::to_string(four / one));
    EXPECT_LT(four, 0.9 * one);
}

std::uint64_t rays_of(const Scene& scene, int branches, int max_depth) {
    PathTracer tracer;
    EXPECT_TRUE(tracer.update(scene));
    PathOptions options = branching_in(branches, 64, 16);
    options.max_depth = max_depth;
    PathStatistics statistics;
    EXPECT_TRUE(tracer.render(scene, into_box(), options, &statistics));
    return statistics.rays;
}

TEST(Branching, IsLeftToWhereAPilotFindsThatItPays) {
    const Scene box = cornell_like();
    EXPECT_GT(rays_of(box, 0, 0), 1.2 * static_cast<double>(rays_of(box, 1, 0))) << "light off walls";
    // Nothing but the choice among forty lamps varies: branches would find nothing.
    Scene lamps = box_scene(false);
    for (int i = 0; i < 40; ++i)
        add_light(lamps, point_light(i % 7 == 0 ? 30.0f : 1.0f, .02f), {-.9f + .045f * static_cast<float>(i), 1.9f, .5f});
    EXPECT_LT(rays_of(lamps, 0, 1), 1.1 * static_cast<double>(rays_of(lamps, 1, 1))) << "direct light alone";
}

TEST(Branching, OfANumberThatIsNoPowerOfTwoUpToFourIsRefused) {
    PathTracer tracer;
    const Scene scene = box_scene();
    ASSERT_TRUE(tracer.update(scene));
    for (const int branches : {-1, 3, 8}) {
        const auto picture = tracer.render(scene, into_box(), branching_in(branches, 8, 1));
        ASSERT_FALSE(picture) << branches;
        EXPECT_NE(picture.error().text().find("1, 2 or 4 branches"), std::string::npos) << picture.error().text();
    }
}

}  // namespace
}  // namespace heliodon::tests
