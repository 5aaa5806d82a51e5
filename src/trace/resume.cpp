#include "trace/resume.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "trace/scene_digest.h"

namespace heliodon::trace {
namespace {

constexpr const char* prefix = "resume.";
constexpr const char* done_name = "resume.samples";
// Of the sequences of samples and of what is stored: another is not gone on from.
constexpr const char* format_version = "2";

// A double is the sum of three floats to its last bit: 24 + 24 + 5 bits of its 53.
constexpr std::array part_names{".high", ".middle", ".low"};

std::string sum_name(const char* kind, std::size_t half, const char* part) {
    return fmt::format("{}{}{}{}", prefix, kind, half, part);
}

void store_sums(const char* kind, const std::vector<glm::dvec3>& sums, std::size_t halves, Picture& picture) {
    const int width = picture.image.width, height = picture.image.height;
    for (std::size_t half = 0; half < halves && !sums.empty(); ++half)
        for (std::size_t part = 0; part < part_names.size(); ++part) {
            Image image(width, height, 3);
            for (std::size_t i = 0; i < image.pixels.size(); ++i) {
                double rest = sums[i / 3 * halves + half][static_cast<int>(i % 3)];
                for (std::size_t before = 0; before < part; ++before) rest -= static_cast<float>(rest);
                image.pixels[i] = static_cast<float>(rest);
            }
            picture.layers.push_back({sum_name(kind, half, part_names[part]), std::move(image)});
        }
}

/// Layers by name, of the right size and number of channels.
class StoredLayers {
public:
    StoredLayers(const Picture& picture, Blocks blocks) : picture_(picture), blocks_(blocks) {}

    [[nodiscard]] Result<const Image*> find(const std::string& name, int channels) const {
        for (const Layer& layer : picture_.layers) {
            if (layer.name != name) continue;
            if (layer.image.width == blocks_.width && layer.image.height == blocks_.height &&
                layer.image.channels == channels)
                return &layer.image;
            break;
        }
        return fail("", fmt::format("expected a layer {} of {}x{} pixels and {} channels to go on from", name,
                                    blocks_.width, blocks_.height, channels));
    }
    Result<void> read_sums(const char* kind, std::size_t halves, std::vector<glm::dvec3>& sums) const {
        for (std::size_t half = 0; half < halves && !sums.empty(); ++half)
            for (const char* part : part_names) {
                auto image = find(sum_name(kind, half, part), 3);
                if (!image) return tl::unexpected(image.error());
                for (std::size_t i = 0; i < (*image)->pixels.size(); ++i)
                    sums[i / 3 * halves + half][static_cast<int>(i % 3)] += (*image)->pixels[i];
            }
        return {};
    }

private:
    const Picture& picture_;
    Blocks blocks_;
};

/// A layer of what each block holds two of.
template <class Value>
Image block_image(const Blocks& blocks, Value&& value) {
    Image image(blocks.width, blocks.height, 2);
    for (int y = 0; y < blocks.height; ++y)
        for (int x = 0; x < blocks.width; ++x)
            for (int half = 0; half < 2; ++half)
                image.at(x, y, half) = static_cast<float>(value(blocks.of(x, y), half));
    return image;
}

void store_decisions(const Blocks& blocks, const AdaptiveSampling& adaptive, Picture& picture) {
    Image sums(blocks.width, blocks.height, 4);
    for (std::size_t i = 0; i < adaptive.decision_sums().size(); ++i)
        for (int c = 0; c < 4; ++c) sums.pixels[4 * i + c] = adaptive.decision_sums()[i][c];
    picture.layers.push_back({"resume.decision", std::move(sums)});
    picture.layers.push_back({"resume.sufficed", block_image(blocks, [&](int block, int half) {
                                  return adaptive.block(block).sufficed[half];
                              })});
    picture.layers.push_back({"resume.stopped", block_image(blocks, [&](int block, int half) {
                                  return adaptive.block(block).stopped[half];
                              })});
}

Result<void> read_decisions(const StoredLayers& layers, const Blocks& blocks, int done, AdaptiveSampling& adaptive) {
    const auto sums = layers.find("resume.decision", 4);
    if (!sums) return tl::unexpected(sums.error());
    const auto sufficed = layers.find("resume.sufficed", 2), stopped = layers.find("resume.stopped", 2);
    if (!sufficed) return tl::unexpected(sufficed.error());
    if (!stopped) return tl::unexpected(stopped.error());
    std::vector<glm::vec4> decision((*sums)->pixels.size() / 4);
    for (std::size_t i = 0; i < (*sums)->pixels.size(); ++i)
        decision[i / 4][static_cast<int>(i % 4)] = (*sums)->pixels[i];
    std::vector<AdaptiveSampling::Block> state(static_cast<std::size_t>(blocks.count()));
    for (int block = 0; block < blocks.count(); ++block)
        for (int half = 0; half < 2; ++half) {
            const int x = block % blocks.across() * Blocks::side, y = block / blocks.across() * Blocks::side;
            const float first = (*sufficed)->at(x, y, half), last = (*stopped)->at(x, y, half);
            if (!(first >= 0 && first <= done && last >= 0 && last <= done))
                return fail("", "the sample counts to go on from are damaged");
            state[block].sufficed[half] = static_cast<int>(first);
            state[block].stopped[half] = static_cast<int>(last);
        }
    adaptive.restore(std::move(decision), std::move(state));
    return {};
}

}  // namespace

RenderIdentity render_identity(const CpuKernel& kernel, const PathOptions& options) {
    return {{"format", format_version},
            {"size", fmt::format("{}x{}", options.width, options.height)},
            {"seed", fmt::format("{}", options.seed)},
            {"integrator", options.integrator == Integrator::bidirectional ? "bidirectional" : "path"},
            {"max-depth", fmt::format("{}", options.max_depth)},
            {"blue-noise", kernel.frame.tile_bits > 0 ? "yes" : "no"},
            {"branches", fmt::format("{}", 1u << kernel.frame.branch_bits)},
            {"light-selection", options.light_tree ? "tree" : "flux"},
            {"environment", options.environment ? "yes" : "no"},
            {"target-error", options.target_error ? fmt::format("{}", *options.target_error) : "none"},
            {"variance", kernel.frame.sample_streams > 1 ? "yes" : "no"},
            {"camera", camera_digest(kernel.frame)},
            {"scene", scene_digest(kernel)}};
}

void store_state(const Accumulation& accumulation, const RenderIdentity& identity, Picture& picture) {
    for (const auto& [name, value] : identity) picture.attributes[prefix + name] = value;
    picture.attributes[done_name] = fmt::format("{}", accumulation.done);
    const SampleSums& sums = accumulation.sums;
    store_sums("radiance", sums.radiance, sums.halves, picture);
    store_sums("direct", sums.direct, sums.halves, picture);
    if (!sums.difference.empty()) {
        Image image(picture.image.width, picture.image.height, 2);
        image.pixels = sums.difference;
        picture.layers.push_back({"resume.difference", std::move(image)});
    }
    if (accumulation.adaptive) store_decisions(accumulation.blocks, *accumulation.adaptive, picture);
}

Result<void> restore_state(const Picture& picture, const RenderIdentity& identity, Accumulation& accumulation) {
    const auto done = picture.attributes.find(done_name);
    if (done == picture.attributes.end())
        return fail("", "expected a picture of an interrupted or resumable render (its state is not in this one)");
    for (const char* name : {"format", "size", "seed", "integrator", "max-depth", "target-error", "variance",
                             "blue-noise", "light-selection", "environment", "camera", "scene"}) {
        const auto stored = picture.attributes.find(std::string(prefix) + name);
        const std::string found = stored == picture.attributes.end() ? "nothing" : stored->second;
        if (found != identity.at(name))
            return fail(
                "", fmt::format("cannot go on with another {}: expected {}, found {}", name, identity.at(name), found));
    }
    const std::string& text = done->second;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), accumulation.done);
    if (error != std::errc() || end != text.data() + text.size() || accumulation.done < 1 ||
        accumulation.done > most_samples_per_pixel)
        return fail("", fmt::format("expected a number of samples to go on from, found '{}'", text));

    SampleSums& sums = accumulation.sums;
    const StoredLayers layers(picture, accumulation.blocks);
    if (auto read = layers.read_sums("radiance", sums.halves, sums.radiance); !read) return read;
    if (auto read = layers.read_sums("direct", sums.halves, sums.direct); !read) return read;
    if (!sums.difference.empty()) {
        auto image = layers.find("resume.difference", 2);
        if (!image) return tl::unexpected(image.error());
        sums.difference = (*image)->pixels;
    }
    if (accumulation.adaptive)
        return read_decisions(layers, accumulation.blocks, accumulation.done, *accumulation.adaptive);
    return {};
}

}  // namespace heliodon::trace
