#pragma once

// Comparing renders of one scene: the picture in square parts, each part's mean luminance over many renders.

#include <array>
#include <cmath>

#include "scene_building.h"

namespace heliodon::tests {

inline PathOptions pictures_of(int size, int samples, Integrator integrator, int max_depth = 0) {
    PathOptions options;
    options.width = options.height = size;
    options.samples_per_pixel = samples;
    options.max_depth = max_depth;
    options.integrator = integrator;
    return options;
}

inline constexpr int parts_across = 4, part_count = parts_across * parts_across;

struct PartMeans {
    std::array<double, part_count> sum{}, squares{};
    int renders = 0;

    void add(const Image& image) {
        std::array<double, part_count> means{};
        const int edge = image.width / parts_across;
        for (int y = 0; y < edge * parts_across; ++y)
            for (int x = 0; x < edge * parts_across; ++x)
                means[y / edge * parts_across + x / edge] += luminance(image.rgb(x, y)) / (edge * edge);
        for (int i = 0; i < part_count; ++i) {
            sum[i] += means[i];
            squares[i] += means[i] * means[i];
        }
        ++renders;
    }
    [[nodiscard]] double mean(int part) const { return sum[part] / renders; }
    /// Of the mean.
    [[nodiscard]] double variance(int part) const {
        return std::max(0.0, squares[part] / renders - mean(part) * mean(part)) / (renders - 1);
    }
    [[nodiscard]] double whole() const {
        double total = 0;
        for (int i = 0; i < part_count; ++i) total += mean(i) / part_count;
        return total;
    }
};

/// Welch's test of each part. Chance exceeds 5.5 standard errors once in 600 000 parts with some 46 degrees of freedom
/// (Student's t); these tests look at a thousand. The picture must also be known well enough to say anything.
inline void expect_equal_means(const std::string& name, const PartMeans& a, const PartMeans& b, double precision = 0.03) {
    ASSERT_GT(a.whole(), 0) << name;
    double of_picture = 0;
    for (int i = 0; i < part_count; ++i) {
        const double error = std::sqrt(a.variance(i) + b.variance(i));
        of_picture += error * error / (part_count * part_count);
        EXPECT_NEAR(a.mean(i), b.mean(i), 5.5 * error + 1e-5 * a.whole()) << name << ", part " << i;
    }
    EXPECT_LT(std::sqrt(of_picture), precision * a.whole()) << name << ": too noisy to say anything";
}

inline PartMeans means_of(const Scene& scene, const Camera& camera, PathOptions options, int renders = 24) {
    PathTracer tracer;
    EXPECT_TRUE(tracer.update(scene));
    PartMeans means;
    for (int i = 0; i < renders; ++i) {
        options.seed = static_cast<std::uint32_t>(i);
        auto picture = tracer.render(scene, camera, options);
        EXPECT_TRUE(picture) << (picture ? "" : picture.error().text());
        if (picture) means.add(options.aovs.empty() ? picture->image : picture->layers[0].image);
    }
    return means;
}

inline void expect_both_modes_agree(const std::string& name, const Scene& scene, const Camera& camera, int max_depth = 0,
                             int samples = 4, double precision = 0.03) {
    expect_equal_means(name, means_of(scene, camera, pictures_of(16, 2 * samples, Integrator::path, max_depth)),
                       means_of(scene, camera, pictures_of(16, samples, Integrator::bidirectional, max_depth)), precision);
}

// -- a scene

inline Camera into_box() {
    return looking({0, 1, 3.4f}, {0, 1, 0});
}

inline Material rough_glass() {
    Material glass;
    glass.base_color = {.9f, .95f, 1};
    glass.transmission = 1;
    glass.roughness = .6f;
    return glass;
}

/// A box open to the camera, with a rough metal ball, a coated block and a glass ball where asked.
inline Scene box_scene(bool glass = true) {
    Scene scene;
    const Material white = lambert(.7f);
    Material red = white, metal, coated;
    red.base_color = {.6f, .1f, .05f};
    metal.base_color = {.9f, .6f, .3f};
    metal.metallic = 1;
    metal.roughness = .6f;
    coated.base_color = {.2f, .5f, .3f};
    coated.clearcoat = 1;
    coated.clearcoat_roughness = .6f;
    add_shape(scene, Quad{{-1, 0, -1}, {0, 0, 2}, {2, 0, 0}}, white);
    add_shape(scene, Quad{{-1, 2, -1}, {2, 0, 0}, {0, 0, 2}}, white);
    add_shape(scene, Quad{{-1, 0, -1}, {2, 0, 0}, {0, 2, 0}}, white);
    add_shape(scene, Quad{{-1, 0, -1}, {0, 2, 0}, {0, 0, 2}}, red);
    add_shape(scene, Sphere{{-.5f, .35f, -.2f}, .35f}, metal);
    add_shape(scene, Box{{-.3f, 0, .3f}, {0, .3f, .6f}}, coated);
    if (glass) add_shape(scene, Sphere{{.4f, .45f, .2f}, .4f}, rough_glass());
    return scene;
}

/// A sheet whose normals lean away from its triangles by up to 40°.
inline Geometry leaning_sheet() {
    Geometry sheet = triangle_mesh({{-.6f, .3f, .3f}, {.6f, .3f, .3f}, {.6f, 1.1f, -.3f},
                                    {-.6f, .3f, .3f}, {.6f, 1.1f, -.3f}, {-.6f, 1.1f, -.3f}});
    for (const glm::vec3& position : sheet.mesh.positions)
        sheet.mesh.normals.push_back(glm::normalize(glm::vec3(1.2f * position.x, 1, 1.4f)));
    return sheet;
}

}  // namespace heliodon::tests
