// Skies by formula, panes, and sensors that look where their light comes from.
#include <fmt/format.h>

#include <cmath>
#include <random>

#include "convert/pack.h"
#include "scene_building.h"
#include "shading/cie_sky.h"
#include "shading/sky.h"
#include "trace/cpu_kernel.h"
#include "trace/direction_guide.h"

namespace heliodon::tests {
namespace {

Sky cie_sky(int type, float azimuth_deg = 40, float elevation_deg = 60) {
    Sky sky;
    sky.model = SkyModel::cie;
    sky.cie_type = type;
    sky.zenith_luminance_nits = 1000;
    sky.ground_albedo = 0.3f;
    sky.sun_azimuth_rad = glm::radians(azimuth_deg);
    sky.sun_elevation_rad = glm::radians(elevation_deg);
    return sky;
}

Material pane(std::array<float, 6> transmittance, float reflectance = 0) {
    Material material;
    material.model = MaterialModel::thin;
    material.transmittance = transmittance;
    material.reflectance = reflectance;
    return material;
}

/// CIE 171:2006, 5.5: 6 mm clear glass.
constexpr std::array<float, 6> clear_glass{-.028378f, 3.156075f, -3.058376f, -1.428919f, 4.014235f, -1.775827f};

TEST(CieSkies, OpenGroundAndARoofReceiveWhatQuadratureSays) {
    for (const int type : {1, 3, 6, 9, 12, 15, 16}) {
        Scene scene;
        scene.set_sky(cie_sky(type));
        add_lux(scene, {0, 0, 0}, {0, 1, 0});
        add_lux(scene, {0, 0, 0}, {0, -1, 0});
        const double expected = shading::horizontal_illuminance(convert::pack_sky(scene));
        const auto readings = measure(scene, 1 << 13, 1);
        expect_reading(fmt::format("open ground, CIE sky {}", type), expected, readings[0]);
        EXPECT_NEAR(readings[1].value, 0.3 * expected, 1e-4 * expected) << "the ground shines up evenly";
    }
}

TEST(CieSkies, SceneryIsLitAlikeWhetherTheSkyIsAFormulaOrAPicture) {
    Scene formula;
    formula.set_sky(cie_sky(12));
    add_shape(formula, Quad{{-1, 1, 0.2f}, {2, 0, 0}, {0, 2, 0}}, lambert(.5f, 0, true));
    add_lux(formula, {0, 0, 0}, {0, 1, 0});
    Scene picture = formula;
    const shading::SkyData record = convert::pack_sky(formula);
    Texture texture{.name = "sky", .width = 1024, .height = 512, .format = TextureFormat::float32};
    texture.wrap_v = Wrap::clamp_to_edge;
    std::vector<glm::vec4> texels;
    for (int y = 0; y < texture.height; ++y)
        for (int x = 0; x < texture.width; ++x) {
            const glm::vec2 uv((static_cast<float>(x) + .5f) / 1024, (static_cast<float>(y) + .5f) / 512);
            texels.emplace_back(shading::sky_radiance(record, shading::sky_direction(uv, 0), glm::vec3(1)), 1);
        }
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(texels.data());
    texture.levels.emplace_back(bytes, bytes + texels.size() * sizeof(glm::vec4));
    Sky sky;
    sky.model = SkyModel::image;
    sky.luminance_nits = glm::vec3(1);
    sky.image = picture.add_texture(std::move(texture));
    picture.set_sky(sky);
    const SensorReading a = measure(formula, 1 << 14)[0], b = measure(picture, 1 << 14)[0];
    EXPECT_NEAR(a.value, b.value, 3 * std::hypot(a.half_width_95, b.half_width_95) + 2e-4 * a.value);
}

TEST(Skies, OfEveryFormulaAreSampledByTheDensityThatIsToldByChiSquare) {
    std::vector<Sky> skies;
    for (const int type : {1, 4, 12, 15, 16}) skies.push_back(cie_sky(type, 75, 35));
    for (const float elevation : {60.0f, 3.0f, -8.0f})
        for (const SkyModel model : {SkyModel::hosek, SkyModel::preetham}) {
            skies.push_back(cie_sky(1, 75, elevation));
            skies.back().model = model;
        }
    for (std::size_t type = 0; type < skies.size(); ++type) {
        Scene scene;
        Sky sky = skies[type];
        sky.north_rad = 0.4f;
        scene.set_sky(sky);
        convert::FlatScene flat;
        flat.update(scene);
        trace::TextureTable textures;
        textures.update(flat);
        const trace::GeometryTable geometries = trace::build_geometry_table(flat);
        const trace::EmitterTable emitters = trace::build_emitters(flat, textures, true);
        trace::CpuKernel kernel{flat, geometries, textures, emitters, {}};
        kernel.frame.environment = 1;
        kernel.frame.sky_emitter = emitters.sky_emitter;
        kernel.frame.sky_columns = emitters.sky_columns;
        kernel.frame.sky_rows = emitters.sky_rows;
        constexpr int bins = 16, samples = 1 << 18;
        std::vector<int> counts(bins * bins);
        std::mt19937 random(static_cast<unsigned>(type));
        std::uniform_real_distribution<float> unit(0, 1);
        double solid_angle = 0, flux = 0;
        int across_border = 0;  // of a cell, by rounding
        for (int i = 0; i < samples; ++i) {
            const float u = unit(random), v = unit(random);
            const shading::KernelLightSample sample = kernel.kernel_sample_sky({u, v});
            across_border += std::abs(sample.pdf / kernel.kernel_sky_direction_pdf(sample.direction) - 1) > 1e-4f;
            solid_angle += 1 / (sample.pdf * samples);
            flux += luminance(glm::dvec3(sample.light)) / samples;
            const glm::vec2 uv = shading::sky_uv(sample.direction, sky.north_rad);
            ++counts[static_cast<std::size_t>(std::min(static_cast<int>(uv.y * bins), bins - 1) * bins +
                                              std::min(static_cast<int>(uv.x * bins), bins - 1))];
        }
        // Each bin holds whole cells of the sampling table, in which the density is even.
        const int rows = static_cast<int>(emitters.sky_rows) / bins, columns = static_cast<int>(emitters.sky_columns) / bins;
        double statistic = 0, exact_flux = 0;
        for (int bin = 0; bin < bins * bins; ++bin) {
            double expected = 0;
            for (int row = 0; row < rows; ++row)
                for (int column = 0; column < columns; ++column) {
                    const int r = bin / bins * rows + row, c = bin % bins * columns + column;
                    const double cap = std::cos(pi * r / (rows * bins)) - std::cos(pi * (r + 1) / (rows * bins));
                    const double cell = 2 * pi / (columns * bins) * cap;
                    expected += samples * cell * kernel.kernel_sky_cell_pdf(static_cast<std::uint32_t>(r), static_cast<std::uint32_t>(c));
                    const glm::vec2 middle((static_cast<float>(c) + .5f) / static_cast<float>(columns * bins), (static_cast<float>(r) + .5f) / static_cast<float>(rows * bins));
                    exact_flux += cell * luminance(glm::dvec3(kernel.kernel_sky_radiance(shading::sky_direction(middle, sky.north_rad))));
                }
            statistic += std::pow(counts[static_cast<std::size_t>(bin)] - expected, 2) / expected;
        }
        // χ² with 255 degrees of freedom: mean 255, standard deviation √510; five of them.
        EXPECT_LT(statistic, 255 + 5 * std::sqrt(510.0)) << type;
        EXPECT_LT(across_border, samples / 500) << type;
        EXPECT_NEAR(solid_angle, 4 * pi, 0.02 * 4 * pi) << type;
        EXPECT_NEAR(flux, exact_flux, 0.005 * exact_flux) << type << ": what it brings, over all directions";
    }
}

TEST(Panes, LetACollimatedBeamThroughByItsAngle) {
    for (const float angle_deg : {0.0f, 30.0f, 60.0f, 80.0f}) {
        const float angle = glm::radians(angle_deg), c = std::cos(angle);
        Scene scene;
        add_shape(scene, Quad{{-50, 1, -50}, {0, 0, 100}, {100, 0, 0}}, pane(clear_glass));
        Light sun;
        sun.type = LightType::directional;
        sun.intensity = glm::vec3(1000);
        sun.direction = {std::sin(angle), -std::cos(angle), 0};
        add_light(scene, sun, {0, 0, 0});
        add_lux(scene, {0, 0, 0}, {0, 1, 0});
        double tau = 0;
        for (int i = 5; i >= 0; --i) tau = tau * c + clear_glass[static_cast<std::size_t>(i)];
        expect_reading(fmt::format("CIE 171 5.5, clear glass at {:g}°", angle_deg), 1000 * c * tau, measure(scene, 32)[0]);
    }
}

TEST(Panes, ArePassedWithoutAScatteringEventFromBothSides) {
    Scene scene;
    scene.set_sky(even_sky(100));
    add_shape(scene, Quad{{-5, 0, -5}, {0, 0, 10}, {10, 0, 0}}, pane({0.5f}));
    add_sensor(scene, SensorType::luminance, {0, -1, 0}, {0, 1, 0});
    add_sensor(scene, SensorType::luminance, {0, 1, 0}, {0.6f, -0.8f, 0});
    for (const SensorReading& reading : measure(scene, 32, 1)) EXPECT_NEAR(reading.value, 50, 1e-3);
}

TEST(Panes, WhatTheyMirrorAndWhatTheyPassIsAllOfAnEvenSky) {
    Scene scene;
    scene.set_sky(even_sky(100));
    add_shape(scene, Quad{{-5, 0, -5}, {0, 0, 10}, {10, 0, 0}}, pane({0.7f}, 0.3f));
    add_sensor(scene, SensorType::luminance, {0, -1, 0}, {0, 1, 0});
    add_sensor(scene, SensorType::luminance, {0, 1, 0}, {0.9f, -0.4f, 0});
    for (const SensorReading& reading : measure(scene, 256)) EXPECT_NEAR(reading.value, 100, 0.05);
    // A wall that a pane mirrors: 3/10 of it, and 7/10 of the sky behind.
    add_shape(scene, Quad{{-5, 0, 2}, {0, 5, 0}, {10, 0, 0}}, lambert(0, 1000, true));
    add_sensor(scene, SensorType::luminance, {0, 1, 0}, {0, -0.7f, 0.7f});
    const SensorReading reading = measure(scene, 1 << 14)[2];
    EXPECT_NEAR(reading.value, 370, 3 * reading.half_width_95 + 0.5);
}

TEST(DirectionGuide, SamplesByTheDensityThatItTells) {
    constexpr int side = 8;
    std::vector<double> light(side * side, 0.0);
    light[side * 2 + 5] = 10;
    light[side * 7 + 0] = 3;
    const trace::DirectionGuide guide(side, light, 1);
    // Counts in 16 × 16 cells, four of which make one of the guide's: a grid of samples is off by those on the borders.
    constexpr int cells = 16, samples_a_side = 512, samples = samples_a_side * samples_a_side;
    std::vector<int> counts(cells * cells);
    double integral = 0;
    for (int i = 0; i < samples; ++i) {
        const glm::vec2 u = (glm::vec2(i % samples_a_side, i / samples_a_side) + 0.5f) / static_cast<float>(samples_a_side);
        const auto [direction, pdf] = guide.sample(u);
        ASSERT_NEAR(glm::length(direction), 1, 1e-4);
        ASSERT_NEAR(guide.pdf(direction) / pdf, 1, 2e-2) << "but on the borders of cells";
        integral += 1 / (pdf * samples);
        double turn = std::atan2(direction.y, direction.x) / (2 * pi);
        if (turn < 0) turn += 1;
        const int column = std::min(cells - 1, static_cast<int>(turn * cells));
        const int row = std::min(cells - 1, static_cast<int>((direction.x * direction.x + direction.y * direction.y) * cells));
        ++counts[static_cast<std::size_t>(row * cells + column)];
    }
    for (int i = 0; i < cells * cells; ++i) {
        const glm::vec3 middle = trace::DirectionGuide::direction_in(cells, i % cells, i / cells, {.5f, .5f});
        const double expected = samples * guide.pdf(middle) / (middle.z / pi) / (cells * cells);
        EXPECT_NEAR(counts[static_cast<std::size_t>(i)], expected, 0.03 * expected + 60) << i;
    }
    EXPECT_NEAR(integral, 2 * pi, 0.15) << "solid angle of the hemisphere";
}

/// A black room with a small window in one wall: few directions matter.
Scene dim_room() {
    Scene scene;
    scene.set_sky(cie_sky(12, 180));
    add_shape(scene, Box{{-2, 0, -2}, {2, 3, 2}}, lambert(0, 0, true));
    return scene;
}

TEST(Sensors, AreSampledUntilTheTargetErrorIsReached) {
    Scene scene;
    scene.set_sky(cie_sky(9));
    add_shape(scene, Quad{{-4, 1, -4}, {0, 0, 8}, {3.8f, 0, 0}}, lambert(0, 0, true));
    add_shape(scene, Quad{{.2f, 1, -4}, {0, 0, 8}, {3.8f, 0, 0}}, lambert(0, 0, true));
    add_lux(scene, {0, 0, 0}, {0, 1, 0});
    PathTracer tracer;
    ASSERT_TRUE(tracer.update(scene));
    PathOptions options;
    options.samples_per_pixel = 64;
    options.target_error = 0.002;
    const auto readings = tracer.measure(scene, options);
    ASSERT_TRUE(readings);
    const SensorReading& reading = (*readings)[0];
    EXPECT_GT(reading.half_width_95, 0);
    EXPECT_LE(reading.half_width_95, 0.002 * reading.value);
    const SensorReading plain = measure(scene, 1 << 16)[0];
    EXPECT_NEAR(reading.value, plain.value, 3 * std::hypot(reading.half_width_95, plain.half_width_95));
}

TEST(Sensors, InAClosedBlackRoomReadZero) {
    Scene scene = dim_room();
    add_lux(scene, {0, 0, 0}, {0, 1, 0});
    const SensorReading reading = measure(scene, 1024)[0];
    EXPECT_EQ(reading.value, 0);
    EXPECT_EQ(reading.half_width_95, 0);
}

TEST(Sensors, GiveTheSameReadingsOnAnyNumberOfThreads) {
    Scene scene = small_room();
    add_lux(scene, {0, 0, 0}, {0, 1, 0});
    PathTracer tracer;
    ASSERT_TRUE(tracer.update(scene));
    PathOptions options;
    options.samples_per_pixel = 512;
    std::vector<SensorReading> readings;
    for (const int threads : {1, 2, 8}) {
        options.threads = threads;
        readings.push_back((*tracer.measure(scene, options))[0]);
    }
    for (const SensorReading& reading : readings) {
        EXPECT_EQ(reading.rgb, readings[0].rgb);
        EXPECT_EQ(reading.half_width_95, readings[0].half_width_95);
    }
}

TEST(Sensors, GridsReadLikeSingleSensorsInTheirPlaces) {
    Scene scene = small_room();
    Sensor grid{"grid", SensorType::illuminance, {-.5f, 0, -.5f}, {0, 1, 0}, {}, SensorGrid{{0, 0, 1}, {1, 0, 0}, {3, 2}}};
    scene.add_sensor(grid);
    add_lux(scene, {-.25f, 0, 0}, {0, 1, 0});
    const auto readings = measure(scene, 1 << 13);
    ASSERT_EQ(readings.size(), 7u);
    EXPECT_EQ(readings[1].name, "grid[1,0]");
    EXPECT_EQ(readings[1].position, glm::vec3(-.25f, 0, 0));
    EXPECT_NEAR(readings[1].value, readings[6].value, 3 * std::hypot(readings[1].half_width_95, readings[6].half_width_95));
}

}  // namespace
}  // namespace heliodon::tests
