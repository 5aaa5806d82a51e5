#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "scene_building.h"
#include "shading/fresnel.h"

namespace heliodon::tests {
namespace {

/// A picture of what stands at the origin under an even sky of 1.
Image under_even_sky(const Scene& scene, float half_angle_rad, int size, int samples) {
    Scene lit = scene;
    lit.set_sky({.model = SkyModel::constant, .luminance_nits = glm::vec3(1)});
    Camera camera;
    camera.position = {0, 0, 20};
    camera.target = {0, 0, 0};
    camera.vertical_fov_rad = 2 * half_angle_rad;
    PathTracer tracer;
    EXPECT_TRUE(tracer.update(lit));
    PathOptions options;
    options.width = options.height = size;
    options.samples_per_pixel = samples;
    auto picture = tracer.render(lit, camera, options);
    if (!picture) {
        ADD_FAILURE() << picture.error().text();
        return Image(size, size, 3);
    }
    return std::move(picture->image);
}

glm::dvec3 mean(const Image& image) {
    glm::dvec3 sum(0);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) sum += glm::dvec3(image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2));
    return sum / static_cast<double>(image.width * image.height);
}

/// What of the sky a ball of this material returns.
glm::dvec3 furnace(const Material& material) {
    Scene scene;
    add_shape(scene, Sphere{{0, 0, 0}, 1}, material);
    return mean(under_even_sky(scene, std::atan(0.65f / 20), 16, 64));
}

struct FurnaceCase {
    const char* name;
    Material material;
    double least, most;
};

TEST(MaterialFurnace, WhiteMaterialsReturnTheSky) {
    Material white;
    white.base_color = glm::vec3(1);
    white.roughness = 0.5f;
    std::vector<FurnaceCase> cases(7, {"", white, 0.98, 1.005});
    cases[0].name = "rough diffuse";
    cases[0].material.model = MaterialModel::oren_nayar;
    cases[1].name = "anisotropic metal";
    cases[1].material.metallic = 1;
    cases[1].material.anisotropy = 0.7f;
    cases[2].name = "anisotropic dielectric";
    cases[2].material.anisotropy = 0.5f;
    cases[3].name = "dielectric";
    cases[3].material.model = MaterialModel::dielectric;
    cases[4].name = "sheet";
    cases[4].material.transmission = 1;
    cases[4].material.thin_walled = true;
    cases[5] = {"sheen over white", white, 0.85, 1.005};  // the layers under a sheen get no more than it leaves either way
    cases[5].material.sheen_color = glm::vec3(1);
    cases[5].material.sheen_roughness = 0.5f;
    cases[6] = {"film over white", white, 0.85, 1.005};  // what is under a film gets what the bound of its reflectance leaves
    cases[6].material.iridescence = 1;
    for (const FurnaceCase& test : cases) {
        const glm::dvec3 found = furnace(test.material);
        for (int c = 0; c < 3; ++c) {
            EXPECT_GE(found[c], test.least) << test.name << ' ' << c;
            EXPECT_LE(found[c], test.most) << test.name << ' ' << c;
        }
    }
}

TEST(MaterialFurnace, GoldReturnsItsColour) {
    Material gold;
    gold.model = MaterialModel::conductor;
    gold.metal = NamedMetal::gold;
    gold.roughness = 0;
    Scene scene;
    add_shape(scene, Quad{{-5, -5, 0}, {10, 0, 0}, {0, 10, 0}}, gold);
    const glm::dvec3 found = mean(under_even_sky(scene, 0.01f, 4, 64));
    EXPECT_NEAR(found.x, 1, 0.002) << "1.0219 is out of the gamut";
    EXPECT_NEAR(found.y, 0.7825, 0.002);
    EXPECT_NEAR(found.z, 0.3434, 0.002);
}

TEST(AbsorbingSolid, ASlabSeenAlongItsNormalLosesLightByBeersLaw) {
    Material tea;
    tea.model = MaterialModel::dielectric;
    tea.ior = 1.5f;
    tea.roughness = 0;
    tea.attenuation_color = {0.5f, 0.9f, 1.0f};
    tea.attenuation_distance_m = 0.3f;
    Scene scene;
    add_shape(scene, Box{{-4, -4, -0.3f}, {4, 4, 0.3f}}, tea);
    const glm::dvec3 found = mean(under_even_sky(scene, 0.01f, 4, 4096));
    for (int c = 0; c < 3; ++c) {
        // Every reflection between the faces included: R + (1 − R)² τ / (1 − R τ) of an even sky on both sides.
        const double r = 0.04, tau = std::pow(tea.attenuation_color[c], 2.0);
        EXPECT_NEAR(found[c], r + (1 - r) * (1 - r) * tau / (1 - r * tau), 0.006) << c;
    }
}

TEST(ThinWalled, ASheetShowsWhatIsStraightBehindItAndASolidBendsIt) {
    // A small glowing disk behind a tilted pane: seen through a sheet it stays where it is.
    const auto seen = [](bool thin_walled) {
        Scene scene;
        Material glass;
        glass.base_color = glm::vec3(1);
        glass.transmission = 1;
        glass.roughness = 0;
        glass.thin_walled = thin_walled;
        Transform tilted;
        tilted.rotation = glm::angleAxis(0.9f, glm::vec3(0, 1, 0));
        add_shape(scene, Box{{-3, -3, -0.5f}, {3, 3, 0.5f}}, glass, tilted);
        add_shape(scene, Disk{{0, 0, -6}, {0, 0, 1}, 0.2f}, lambert(0, 100));
        Camera camera;
        camera.position = {0, 0, 20};
        camera.target = {0, 0, 0};
        camera.vertical_fov_rad = 0.004f;  // within the disk
        PathTracer tracer;
        EXPECT_TRUE(tracer.update(scene));
        PathOptions options;
        options.width = options.height = 4;
        options.samples_per_pixel = 256;
        const auto picture = tracer.render(scene, camera, options);
        return picture ? mean(picture->image).y : -1.0;
    };
    const double passed = 1 - shading::fresnel_dielectric(std::cos(0.9f), 1.5f);
    EXPECT_NEAR(seen(true), 100 * passed * passed, 1.5);
    EXPECT_LT(seen(false), 1) << "a solid of a metre moves the view by decimetres";
}

}  // namespace
}  // namespace heliodon::tests
