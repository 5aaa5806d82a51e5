#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "app/cli/commands.h"
#include "app/cli/option_values.h"
#include "app/cli/terminal.h"
#include "core/image_io.h"
#include "core/metrics.h"
#include "core/units.h"

namespace heliodon::cli {
namespace {

struct CompareOptions {
    std::string reference, test;
    std::string heatmap, difference;
    std::optional<float> ev100;
    bool json = false;
};

/// The metrics look at RGB: alpha is dropped, grey repeated.
Image rgb_of(const Image& image) {
    if (image.channels == 3) return image;
    Image result(image.width, image.height, 3);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            for (int c = 0; c < 3; ++c) result.at(x, y, c) = image.rgb(x, y)[c];
    return result;
}

Result<Image> read_rgb(const std::string& path, std::optional<float>& ev100) {
    auto picture = read_picture(path);
    if (!picture) return tl::unexpected(picture.error());
    if (picture->has_ev100) ev100 = picture->ev100;
    return rgb_of(picture->image);
}

Result<void> write_heatmap(const std::string& path, const Image& reference, const Image& test, float ev100) {
    auto map = flip_map(reference, test, ev100);
    if (!map) return tl::unexpected(map.error());
    Picture picture;
    picture.image = is_display_format(path) ? heatmap(*map) : rgb_of(*map);
    return write_picture(path, picture);
}

/// Test − reference. Display formats show its luminance from blue (darker than the reference) by white to red.
Result<void> write_difference(const std::string& path, const Image& reference, const Image& test, float ev100) {
    constexpr float full_colour = 0.25f;  // of what just saturates
    constexpr glm::vec3 darker{0.02f, 0.19f, 0.38f}, brighter{0.4f, 0.0f, 0.12f};
    const float scale = 1 / (1.2f * std::exp2(ev100) * full_colour);
    Picture picture;
    picture.image = Image(reference.width, reference.height, 3);
    for (int y = 0; y < reference.height; ++y)
        for (int x = 0; x < reference.width; ++x) {
            glm::vec3 value = test.rgb(x, y) - reference.rgb(x, y);
            if (is_display_format(path)) {
                const float signed_share = glm::clamp(units::luminance(value) * scale, -1.0f, 1.0f);
                value = glm::mix(glm::vec3(1), signed_share < 0 ? darker : brighter, std::abs(signed_share));
            }
            for (int c = 0; c < 3; ++c) picture.image.at(x, y, c) = value[c];
        }
    return write_picture(path, picture);
}

Result<void> compare_pictures(const CompareOptions& options) {
    for (const std::string& path : {options.heatmap, options.difference})
        if (!path.empty())
            if (auto checked = check_writable(path); !checked) return checked;
    std::optional<float> stored, unused;
    auto reference = read_rgb(options.reference, stored);
    if (!reference) return tl::unexpected(reference.error());
    auto test = read_rgb(options.test, unused);
    if (!test) return tl::unexpected(test.error());

    // Without any exposure the values are compared as they stand: 1.2 · 2^EV100 = 1.
    const bool known = options.ev100 || stored;
    const float ev100 = options.ev100 ? *options.ev100 : stored.value_or(std::log2(1.0f / 1.2f));
    auto metrics = compare(*reference, *test, ev100);
    if (!metrics) return fail(options.test, metrics.error().text());
    if (!known)
        report_warnings({{options.reference, "stores no ev100: its values are compared as they stand (see --ev100)"}});
    if (!options.heatmap.empty())
        if (auto written = write_heatmap(options.heatmap, *reference, *test, ev100); !written) return written;
    if (!options.difference.empty())
        if (auto written = write_difference(options.difference, *reference, *test, ev100); !written) return written;

    const std::pair<const char*, double> rows[] = {
        {"mse", metrics->mse},
        {"rmse", metrics->rmse},
        {"relmse", metrics->relmse},
        {"mae", metrics->mae},
        {"median_relative", metrics->median_relative},
        {"psnr", metrics->psnr},
        {"ssim", metrics->ssim},
        {"flip", metrics->flip},
    };
    nlohmann::ordered_json values;
    std::string table;
    for (const auto& [name, value] : rows) {
        values[name] = value;
        table += fmt::format("{:<16}{:.6g}\n", name, value);
    }
    return print(options.json ? values.dump(2) + "\n" : table);
}

}  // namespace

Action declare_compare(CLI::App& command) {
    auto options = std::make_shared<CompareOptions>();
    command.add_option("REFERENCE", options->reference, "The picture held to be right")->required();
    command.add_option("TEST", options->test, "The picture to judge, of the same size")->required();
    command.add_option("--heatmap", options->heatmap, "Write the FLIP error a pixel as a picture");
    command.add_option("--difference", options->difference,
                       "Write test - reference as a picture: blue where the test is darker by a quarter of what saturates, red where brighter");
    command.add_option_function<std::string>(
        "--ev100", [options = options.get()](const std::string& text) { options->ev100 = read_ev100(text); },
        "Exposure, instead of the one that the reference stores");
    command.add_flag("--json", options->json, "Print JSON, one key a metric (an infinite psnr is null)");
    return [options] { return compare_pictures(*options); };
}

}  // namespace heliodon::cli
