// Veach's scene of plates and lights (Veach & Guibas 1995, "Optimally Combining Sampling Techniques", figure 2): four
// plates of rising roughness mirror four spheres of equal power. The path tracer's own kernel with and without its weights.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/parallel.h"
#include "import/import.h"
#include "picture_means.h"
#include "trace/cpu_kernel.h"
#include "trace/embree_scene.h"

namespace heliodon::tests {
namespace {

using namespace trace;

/// The same kernel once more, where each technique's light counts in full.
struct UnweightedKernel : CpuKernel {
    explicit UnweightedKernel(const CpuKernel& kernel) : CpuKernel(kernel) {}
    static float power_heuristic(float /*density*/, float /*other*/) { return 1; }

#undef HELIODON_SHADING_PATH_KERNEL_H
#undef HELIODON_SHADING_KERNEL_SCATTER_H
#include "shading/path_kernel.h"
};

constexpr int width = 64, height = 48, cell_edge = 8, columns = width / cell_edge, cells = columns * height / cell_edge;
constexpr int first_of_plates = 2 * columns;  // above, the camera sees the lights themselves
constexpr int batches = 24, samples_a_batch = 16;

/// One technique's picture, in square cells.
struct Estimate {
    std::array<std::array<double, batches>, cells> batch_means{};  ///< independent of each other
    std::array<double, cells> sample_variance{};                    ///< of one sample, mean over the cell's pixels

    [[nodiscard]] double mean(int cell) const {
        double sum = 0;
        for (const double value : batch_means[cell]) sum += value / batches;
        return sum;
    }
    [[nodiscard]] double variance_of_mean(int cell) const {
        double squares = 0;
        for (const double value : batch_means[cell]) squares += (value - mean(cell)) * (value - mean(cell));
        return squares / (batches * (batches - 1));
    }
    [[nodiscard]] double variance_on_plates() const {
        double sum = 0;
        for (int cell = first_of_plates; cell < cells; ++cell) sum += sample_variance[cell] / (cells - first_of_plates);
        return sum;
    }
};

template <class Kernel>
Estimate estimate(const Kernel& shared_kernel, const EmbreeScene& embree) {
    Estimate result;
    parallel_for(cells, 1, [&](std::size_t begin, std::size_t end) {
        Kernel kernel = shared_kernel;
        for (std::size_t cell = begin; cell < end; ++cell)
            for (int pixel = 0; pixel < cell_edge * cell_edge; ++pixel) {
                const auto x = static_cast<shading::uint>(cell % columns * cell_edge + pixel % cell_edge);
                const auto y = static_cast<shading::uint>(cell / columns * cell_edge + pixel / cell_edge);
                double sum = 0, squares = 0;
                for (int batch = 0; batch < batches; ++batch)
                    for (int i = 0; i < samples_a_batch; ++i) {
                        kernel.frame.seed = static_cast<std::uint32_t>(batch);
                        PathState path = kernel.path_begin(x, y, static_cast<shading::uint>(i));
                        for (KernelRay ray = kernel.path_next_ray(path); ray.kind != kernel_ray_none; ray = kernel.path_next_ray(path))
                            kernel.path_take_hit(path, embree.trace(ray));
                        const double light = luminance(glm::dvec3(path.radiance));
                        result.batch_means[cell][batch] += light / (samples_a_batch * cell_edge * cell_edge);
                        sum += light;
                        squares += light * light;
                    }
                constexpr double samples = batches * samples_a_batch;
                result.sample_variance[cell] += (squares - sum * sum / samples) / (samples - 1) / (cell_edge * cell_edge);
            }
    });
    return result;
}

class VeachsLights : public testing::Test {
protected:
    void SetUp() override {
        Warnings warnings;
        auto loaded = load_scene(std::string(HELIODON_SOURCE_DIR) + "/tests/scenes/veach-lights.heliodon.json", {}, warnings);
        ASSERT_TRUE(loaded) << loaded.error().text();
        scene_ = std::move(*loaded);
        // A black room: by scattered rays alone its light would never settle.
        std::vector<MaterialId> rooms;
        scene_.materials().each([&](MaterialId id, const Material& material) {
            if (material.name == "room") rooms.push_back(id);
        });
        ASSERT_EQ(rooms.size(), 1u);
        Material black = *scene_.materials().find(rooms[0]);
        black.base_color = glm::vec3(0);
        scene_.set_material(rooms[0], black);
        ASSERT_TRUE(embree_.update(flat_, flat_.update(scene_)));
        geometries_ = build_geometry_table(flat_);
        emitters_ = build_emitters(flat_, textures_, true);
    }
    /// Direct light.
    [[nodiscard]] CpuKernel kernel() const {
        CpuKernel kernel{flat_, geometries_, textures_, emitters_, {}};
        scene_.cameras().each([&](CameraId, const Camera& camera) {
            const glm::mat4 view = camera.world_to_view();
            const float tangent = std::tan(0.5f * camera.vertical_fov_rad);
            const auto axis = [&](int row) { return glm::vec3(view[0][row], view[1][row], view[2][row]); };
            kernel.frame.camera_position = camera.position;
            kernel.frame.camera_right = axis(0) * (tangent * width / height);
            kernel.frame.camera_up = axis(1) * tangent;
            kernel.frame.camera_forward = -axis(2);
        });
        kernel.frame.width = width;
        kernel.frame.height = height;
        kernel.frame.max_depth = 1;
        kernel.frame.sample_streams = 1;
        kernel.frame.sky_emitter = emitters_.sky_emitter;
        kernel.frame.distant_emitters = emitters_.distant_emitters;
        kernel.frame.emitter_count = static_cast<shading::uint>(emitters_.emitters.size());
        kernel.frame.light_node_count = static_cast<shading::uint>(emitters_.light_nodes.size());
        kernel.frame.scattered_emission = 1;
        return kernel;
    }
    /// With so many scattered rays, as a power of 2, to a light sample.
    [[nodiscard]] Estimate combined(shading::uint branch_bits = 0) const {
        CpuKernel both = kernel();
        both.frame.branch_bits = branch_bits;
        return estimate(both, embree_);
    }
    [[nodiscard]] Estimate by_lights_alone() const {
        UnweightedKernel alone(kernel());
        alone.frame.scattered_emission = 0;
        return estimate(alone, embree_);
    }
    [[nodiscard]] Estimate by_materials_alone() const {
        UnweightedKernel alone(kernel());
        alone.frame.emitter_count = 0;
        return estimate(alone, embree_);
    }

private:
    Scene scene_;
    convert::FlatScene flat_;
    EmbreeScene embree_;
    TextureTable textures_;
    GeometryTable geometries_;
    EmitterTable emitters_;
};

/// Darker cells hold what neither plate nor light is in, and the far ends of lobes.
constexpr double least_mean = 0.03;

/// Where a technique finds light too seldom to say anything its mean is not judged: most of the others must be.
/// Chance exceeds 5.5 standard errors once in 600 000 cells (Student's t, some 46 degrees of freedom).
void expect_same_means(const char* name, const Estimate& alone, const Estimate& both, int least_judged) {
    int judged = 0;
    for (int cell = first_of_plates; cell < cells; ++cell) {
        const double mean = both.mean(cell), variance = alone.variance_of_mean(cell);
        if (mean < least_mean || std::sqrt(variance) > 0.12 * mean) continue;
        ++judged;
        EXPECT_NEAR(alone.mean(cell), mean, 5.5 * std::sqrt(variance + both.variance_of_mean(cell))) << name << ", cell " << cell;
    }
    EXPECT_GE(judged, least_judged) << name;
}

/// The cells where a plate mirrors a light: rows of rising roughness, from the smallest light to the largest.
constexpr int mirrored[4][4] = {{17, 19, 20, 22}, {25, 27, 28, 30}, {33, 35, 36, 38}, {41, 43, 44, 46}};

void print_deviations(const Estimate& lights, const Estimate& materials, const Estimate& both) {
    for (const auto& plate : mirrored) {
        fmt::print("|");
        for (const int cell : plate) {
            const auto relative = [&](double variance) { return std::sqrt(variance) / both.mean(cell); };
            fmt::print(" {:.2f} / {:.2f} / {:.2f} |", relative(lights.sample_variance[cell] / 2),
                       relative(materials.sample_variance[cell] / 2), relative(both.sample_variance[cell]));
        }
        fmt::print("\n");
    }
    fmt::print("whole: {:.4g} / {:.4g} / {:.4g}\n", lights.variance_on_plates() / 2, materials.variance_on_plates() / 2, both.variance_on_plates());
}

TEST_F(VeachsLights, EachTechniqueAloneHasTheMeanOfBothTogetherWhichVaryLess) {
    const Estimate both = combined(), lights = by_lights_alone(), materials = by_materials_alone();
    expect_same_means("by lights alone", lights, both, 16);
    expect_same_means("by materials alone", materials, both, 10);
    expect_same_means("four scattered rays to a light sample", combined(2), both, 18);
    if (std::getenv("HELIODON_VALIDATION_TABLE")) print_deviations(lights, materials, both);

    // A sample of both against two of the better one.
    EXPECT_LT(both.variance_on_plates(), 0.5 * std::min(lights.variance_on_plates(), materials.variance_on_plates()) / 2);
    // Nowhere more than a sample of the better one by a bound: Veach 1997, theorem 9.2 (of the balance heuristic).
    for (int cell = first_of_plates; cell < cells; ++cell) {
        const double better = std::min(lights.sample_variance[cell], materials.sample_variance[cell]), mean = both.mean(cell);
        if (mean < least_mean) continue;
        EXPECT_LT(both.sample_variance[cell], 1.1 * better + mean * mean / 2) << "cell " << cell;
    }
    // The smoothest plate and the largest light, the roughest and the smallest: one technique fails, both together do not.
    EXPECT_LT(both.sample_variance[22], 1e-3 * lights.sample_variance[22]);
    EXPECT_LT(both.sample_variance[41], 1e-2 * materials.sample_variance[41]);
}

}  // namespace
}  // namespace heliodon::tests
