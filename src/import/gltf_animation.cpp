#include <fmt/format.h>
#include <tiny_gltf.h>

#include "import/gltf.h"

namespace heliodon::import::gltf {
namespace {

struct Notes {
    bool weights = false, others = false;
};

/// One channel, or nothing where it drives what is not read.
std::optional<AnimationChannel> read_channel(const Document& document, const tinygltf::Animation& animation,
                                             std::size_t index, const std::string& at, Notes& notes) {
    const tinygltf::AnimationChannel& source = animation.channels[index];
    const tinygltf::AnimationSampler& sampler = animation.samplers[std::size_t(source.sampler)];
    AnimationChannel channel;
    if (source.target_path == "translation")
        channel.property = AnimatedProperty::node_translation;
    else if (source.target_path == "rotation")
        channel.property = AnimatedProperty::node_rotation;
    else if (source.target_path == "scale")
        channel.property = AnimatedProperty::node_scale;
    else {
        notes.weights |= source.target_path == "weights";
        notes.others |= source.target_path != "weights";
        return std::nullopt;
    }
    // A channel without a node is to be ignored (glTF 2.0, section 3.11).
    if (source.target_node < 0) return std::nullopt;
    if (sampler.interpolation == "STEP")
        channel.interpolation = Interpolation::step;
    else if (sampler.interpolation == "LINEAR")
        channel.interpolation = Interpolation::linear;
    else if (sampler.interpolation == "CUBICSPLINE")
        channel.interpolation = Interpolation::cubic;
    else
        document.refuse(at,
                        "expected interpolation STEP, LINEAR or CUBICSPLINE, found \"" + sampler.interpolation + "\"");

    const int width = channel.property == AnimatedProperty::node_rotation ? 4 : 3;
    const std::size_t input = std::size_t(sampler.input), output = std::size_t(sampler.output);
    const std::size_t keys = document.accessor(input).count;
    const std::size_t values = keys * (channel.interpolation == Interpolation::cubic ? 3 : 1);
    if (document.accessor(input).components != 1) document.refuse(at, "expected scalar key times");
    if (document.accessor(output).components != width || document.accessor(output).count != values)
        document.refuse(
            at, fmt::format("expected {} values of {} components for {} keys, found {} of {}", values, width, keys,
                            document.accessor(output).count, document.accessor(output).components));
    document.expect_affordable(input, at + ".input");
    document.expect_affordable(output, at + ".output");
    channel.times_s.resize(keys);
    document.read_floats(input, 1, channel.times_s.data(), at + ".input");
    for (std::size_t i = 1; i < keys; ++i)
        if (!(channel.times_s[i] > channel.times_s[i - 1]))
            document.refuse(at + ".input", fmt::format("expected increasing key times, found {} after {}",
                                                       channel.times_s[i], channel.times_s[i - 1]));
    channel.values.resize(values * std::size_t(width));
    document.read_floats(output, width, channel.values.data(), at + ".output");
    return channel;
}

}  // namespace

std::vector<AnimationDraft> read_animations(const Document& document, const tinygltf::Model& model,
                                            Warnings& warnings) {
    std::vector<AnimationDraft> drafts;
    Notes notes;
    for (std::size_t i = 0; i < model.animations.size(); ++i) {
        const tinygltf::Animation& source = model.animations[i];
        AnimationDraft draft;
        draft.animation.name = source.name.empty() ? fmt::format("animation {}", i) : source.name;
        for (std::size_t c = 0; c < source.channels.size(); ++c) {
            const std::string at = fmt::format("$.animations[{}].samplers[{}]", i, source.channels[c].sampler);
            std::optional<AnimationChannel> channel = read_channel(document, source, c, at, notes);
            if (!channel) continue;
            draft.animation.channels.push_back(std::move(*channel));
            draft.target_nodes.push_back(std::size_t(source.channels[c].target_node));
        }
        drafts.push_back(std::move(draft));
        // tinygltf leaves out channels without a node, such as KHR_animation_pointer's.
        notes.others |= source.channels.size() < document.json()["animations"][i]["channels"].size();
    }
    if (notes.weights) warnings.push_back({document.path().string(), "ignores animated morph weights"});
    if (notes.others)
        warnings.push_back(
            {document.path().string(), "ignores animations of anything but nodes' translation, rotation and scale"});
    return drafts;
}

void add_animations(std::vector<AnimationDraft> drafts, const std::vector<NodeId>& nodes, Scene& scene) {
    for (AnimationDraft& draft : drafts) {
        Animation animation{.name = std::move(draft.animation.name), .channels = {}};
        for (std::size_t c = 0; c < draft.target_nodes.size(); ++c) {
            const NodeId node = nodes[draft.target_nodes[c]];
            if (!node) continue;
            draft.animation.channels[c].target = node;
            animation.channels.push_back(std::move(draft.animation.channels[c]));
        }
        if (!animation.channels.empty()) scene.add_animation(std::move(animation));
    }
}

}  // namespace heliodon::import::gltf
