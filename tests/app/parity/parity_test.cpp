// The real-time engine's direct light against the path tracer's, on exposed values. References are versioned
// (tests/references/README.md says how they are made); with HELIODON_FULL set they are rendered here, 512×512.
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "app/program.h"
#include "shared_data.h"

namespace heliodon::tests {
namespace {

using nlohmann::json;

class Parity : public ProgramTest {
protected:
    [[nodiscard]] static bool full() { return std::getenv("HELIODON_FULL") != nullptr; }

    /// Renders `scene` in real time and compares it with the reference of that name.
    void measure(const std::filesystem::path& scene, const std::string& name) {
        const std::string size = full() ? "512x512" : "256x256";
        std::filesystem::path reference =
            std::filesystem::path(HELIODON_SOURCE_DIR) / "tests/references" / (name + ".exr");
        if (full()) {
            reference = folder() / "path.exr";
            const Ended path = run({"render", scene.string(), "--engine", "path", "--max-depth", "1", "--spp", "1024",
                                    "--no-environment", "--size", size, "-o", "path.exr"});
            ASSERT_EQ(path.code, 0) << path.error;
        }
        const Ended realtime =
            run({"render", scene.string(), "--gi", "none", "--no-environment", "--size", size, "-o", "realtime.exr"});
        ASSERT_EQ(realtime.code, 0) << realtime.error;
        const Ended compared = run({"compare", reference.string(), "realtime.exr", "--json"});
        ASSERT_EQ(compared.code, 0) << compared.error;
        metrics_ = json::parse(compared.output);
        for (const char* metric : {"median_relative", "relmse", "flip"})
            RecordProperty(metric, std::to_string(metrics_[metric].get<double>()));
        std::printf("%s %s: median relative %.5f, relMSE %.6f, FLIP %.5f\n", name.c_str(), size.c_str(),
                    metrics_["median_relative"].get<double>(), metrics_["relmse"].get<double>(),
                    metrics_["flip"].get<double>());
    }
    [[nodiscard]] double metric(const char* name) const { return metrics_.at(name).get<double>(); }

private:
    json metrics_;
};

TEST_F(Parity, CornellBoxUnderAPointLight) {
    const auto scene = shared_path("scenes/cornell-point.heliodon.json");
    if (!scene) GTEST_SKIP() << "no shared data";
    ASSERT_NO_FATAL_FAILURE(measure(*scene, "cornell-point"));
    EXPECT_LE(metric("median_relative"), 0.005);
    EXPECT_LE(metric("relmse"), 0.005);
    EXPECT_LE(metric("flip"), 0.03);
}

TEST_F(Parity, CornellBoxUnderPointSpotAndDirectionalLights) {
    ASSERT_NO_FATAL_FAILURE(measure(
        std::filesystem::path(HELIODON_SOURCE_DIR) / "tests/scenes/three-lights.heliodon.json", "three-lights"));
    EXPECT_LE(metric("median_relative"), 0.005);
    EXPECT_LE(metric("relmse"), 0.005);
    EXPECT_LE(metric("flip"), 0.03);
}

TEST_F(Parity, MetalAndDielectricModelsOfNatus) {
    const auto scene = shared_path("scenes/natus.heliodon.json");
    if (!scene) GTEST_SKIP() << "no shared data";
    ASSERT_NO_FATAL_FAILURE(measure(*scene, "natus"));
    EXPECT_LE(metric("flip"), 0.05);
}

}  // namespace
}  // namespace heliodon::tests
