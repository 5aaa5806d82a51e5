// Whatever a file holds, reading it gives one located error or a scene that both engines can render, in bounded
// time and memory, and leaves no file behind. Meant for the sanitizers; bounded by HELIODON_FUZZ_CASES.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <fstream>

#include "core/image_io.h"
#include "damage.h"
#include "import/glb_builder.h"
#include "import/import.h"
#include "realtime/renderer.h"
#include "samples.h"
#include "shared_data.h"
#include "trace/path_tracer.h"

namespace heliodon::tests {
namespace {

std::uint64_t setting(const char* name, std::uint64_t fallback) {
    const char* value = std::getenv(name);
    return value ? std::strtoull(value, nullptr, 10) : fallback;
}

/// A whole GLB taken apart, so that its JSON or its binary chunk can be damaged alone.
struct GlbParts {
    Json json;
    std::string binary;

    explicit GlbParts(const std::string& bytes) {
        const auto word = [&](std::size_t at) {
            std::uint32_t value = 0;
            std::memcpy(&value, bytes.data() + at, sizeof value);
            return value;
        };
        const std::size_t length = word(12);
        json = Json::parse(bytes.substr(20, length));
        if (bytes.size() > 28 + length) binary = bytes.substr(28 + length, word(20 + length));
    }
    [[nodiscard]] std::string glb() const {
        const auto chunk = [](const char* type, const std::string& content) {
            const auto size = static_cast<std::uint32_t>(content.size());
            return std::string(reinterpret_cast<const char*>(&size), 4) + std::string(type, 4) + content;
        };
        const std::string chunks = chunk("JSON", json.dump()) + chunk("BIN\0", binary);
        const std::uint32_t header[] = {2, static_cast<std::uint32_t>(12 + chunks.size())};
        return "glTF" + std::string(reinterpret_cast<const char*>(header), sizeof header) + chunks;
    }
};

enum class Harm { bytes, values };

class Fuzz : public testing::Test {
protected:
    /// `sample` with one of its files damaged.
    Sample damaged(const Sample& sample, Harm harm, Damage& damage) {
        Sample result = sample;
        SampleFile& file = result.files[damage.one_in(3) ? damage.pick(result.files.size()) : 0];
        const std::string ending = std::filesystem::path(file.name).extension().string();
        if (ending == ".glb" && (harm == Harm::values || !damage.one_in(3))) {
            GlbParts parts(file.bytes);
            if (harm == Harm::values)
                parts.json = damage.values(std::move(parts.json));
            else
                parts.binary = damage.bytes(std::move(parts.binary));
            file.bytes = parts.glb();
        } else if (harm == Harm::values && (ending == ".gltf" || ending == ".json")) {
            file.bytes = damage.values(Json::parse(file.bytes)).dump();
        } else if (harm == Harm::values && (ending == ".obj" || ending == ".mtl" || ending == ".ies" || ending == ".ldt")) {
            file.bytes = damage.words(std::move(file.bytes));
        } else {
            file.bytes = damage.bytes(std::move(file.bytes));
        }
        return result;
    }

    void write(const Sample& sample) const {
        for (const SampleFile& file : sample.files) (void)folder_.write(file.name, file.bytes);
    }
    [[nodiscard]] std::filesystem::path opened(const Sample& sample) const { return folder_ / sample.opened; }
    [[nodiscard]] std::size_t file_count() const {
        return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder_ / ""), {}));
    }

    /// The scene of the sample's files, if it can be read; else one located error.
    std::optional<Scene> read(const Sample& sample) {
        write(sample);
        const std::size_t files = file_count();
        Warnings warnings;
        Result<Scene> scene = load_scene(opened(sample), {}, warnings);
        EXPECT_EQ(file_count(), files);
        if (scene) {
            ++read_;
            return std::move(*scene);
        }
        ++refused_;
        const Error& error = scene.error();
        EXPECT_NE(error.where.find('/'), std::string::npos) << "names no file: " << error.text();
        EXPECT_FALSE(error.message.empty());
        return std::nullopt;
    }

    static void expect_sound(const Scene& scene) {
        scene.geometries().each([](GeometryId, const Geometry& geometry) {
            const Mesh& mesh = geometry.mesh;
            for (const std::uint32_t index : mesh.indices) ASSERT_LT(index, mesh.positions.size());
            for (const glm::vec3& p : mesh.positions) ASSERT_TRUE(std::isfinite(p.x + p.y + p.z));
            for (const glm::vec3& n : mesh.normals) ASSERT_NEAR(glm::length(n), 1, 1e-3);
        });
    }
    static Camera first_camera(const Scene& scene) {
        std::optional<Camera> camera;
        scene.cameras().each([&](CameraId, const Camera& each) {
            if (!camera) camera = each;
        });
        return camera.value_or(Camera{});
    }
    static void expect_picture(const Result<Picture>& picture) {
        if (!picture) {
            EXPECT_FALSE(picture.error().text().empty());
            return;
        }
        for (const float value : picture->image.pixels) ASSERT_TRUE(std::isfinite(value)) << value;
    }
    static void trace(const Scene& scene) {
        PathTracer tracer;
        const auto updated = tracer.update(scene);
        if (!updated) return;
        PathOptions options;
        options.width = options.height = 4;
        options.samples_per_pixel = 1;
        options.max_depth = 8;
        options.aovs = {"albedo", "normal", "depth", "position"};
        expect_picture(tracer.render(scene, first_camera(scene), options));
        (void)tracer.measure(scene, options);
    }
    static void rasterize(const Scene& scene) {
        auto renderer = RealtimeRenderer::create({});
        ASSERT_TRUE(renderer) << renderer.error().text();
        if (!renderer->update(scene)) return;
        RealtimeOptions options;
        options.width = options.height = 16;
        options.samples = 1;
        expect_picture(renderer->render(scene, first_camera(scene), options));
    }

    /// `count` cases, each `sample` damaged anew. A case that fails leaves its files and says its seed.
    template <class Look>
    void campaign(const std::vector<Sample>& whole, Harm harm, std::size_t count, Look&& look) {
        const std::uint64_t first = setting("HELIODON_FUZZ_SEED", 1);
        count = setting("HELIODON_FUZZ_CASES", count);
        for (std::uint64_t seed = first; seed < first + count && !HasFailure(); ++seed) {
            const auto start = std::chrono::steady_clock::now();
            Damage damage(seed);
            const Sample& sample = whole[seed % whole.size()];
            const Sample harmed = damaged(sample, harm, damage);
            keep_for_the_dead(harmed, seed);
            if (std::optional<Scene> scene = read(harmed)) look(*scene);
            const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
            EXPECT_LT(took.count(), 20);
            if (HasFailure()) ADD_FAILURE() << sample.name << ", HELIODON_FUZZ_SEED=" << seed;
        }
        RecordProperty("read", read_);
        RecordProperty("refused", refused_);
        std::printf("             %d read, %d refused\n", read_, refused_);
    }

    /// HELIODON_FUZZ_KEEP names a folder that always holds the present case, for crashes to be found there.
    static void keep_for_the_dead(const Sample& sample, std::uint64_t seed) {
        const char* folder = std::getenv("HELIODON_FUZZ_KEEP");
        if (!folder) return;
        for (const SampleFile& file : sample.files)
            std::ofstream(std::filesystem::path(folder) / file.name, std::ios::binary) << file.bytes;
        std::ofstream(std::filesystem::path(folder) / "seed") << sample.name << ' ' << seed << '\n';
    }

    TemporaryFolder folder_;
    int read_ = 0, refused_ = 0;
};

TEST_F(Fuzz, WholeSamplesAreReadAndRendered) {
    for (const Sample& sample : samples()) {
        const std::optional<Scene> scene = read(sample);
        ASSERT_TRUE(scene) << sample.name;
        expect_sound(*scene);
        trace(*scene);
    }
}

TEST_F(Fuzz, DamagedBytesAreRefusedOrTraced) {
    campaign(samples(), Harm::bytes, 600, [&](const Scene& scene) {
        expect_sound(scene);
        trace(scene);
    });
}

TEST_F(Fuzz, DamagedValuesAreRefusedOrTraced) {
    campaign(samples(), Harm::values, 600, [&](const Scene& scene) {
        expect_sound(scene);
        trace(scene);
    });
}

TEST_F(Fuzz, DamagedValuesAreRefusedOrRasterized) {
    rasterize(*read(samples()[0]));  // the device's own compilation, once
    campaign(samples(), Harm::values, 8, [&](const Scene& scene) { rasterize(scene); });
}

/// Real models: draco, meshopt, large textures. The smallest one here; all of them in a long campaign.
TEST_F(Fuzz, DamagedModelsAreRefusedOrTraced) {
    std::vector<Sample> models;
    const bool all = std::getenv("HELIODON_FUZZ_CASES") != nullptr;
    for (const char* name : {"suzanne.glb", "lucy.glb", "damaged-helmet.glb", "car.glb", "dragon.glb", "teapot.obj"}) {
        const auto path = shared_path(std::string("models/") + name);
        if (!path) GTEST_SKIP() << "needs the shared models";
        models.push_back({name, name, {{name, read_file(*path).value()}}});
        if (!all) break;
    }
    campaign(models, Harm::bytes, 6, [&](const Scene& scene) {
        expect_sound(scene);
        trace(scene);
    });
}

}  // namespace
}  // namespace heliodon::tests
