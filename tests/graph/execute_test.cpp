#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "graph/executor.h"
#include "test_graph_shaders.h"

namespace heliodon::graph {
namespace {

template <class T>
T value_of(Result<T> result) {
    if (!result) throw std::runtime_error(result.error().text());
    return std::move(*result);
}
void expect_ok(const Result<void>& result) {
    EXPECT_TRUE(result) << result.error().text();
}

/// Frames on a real device under validation; every test ends without a message.
class Execution : public testing::Test {
protected:
    static void SetUpTestSuite() {
        gpu::InstanceSettings settings;
        settings.validation = true;
        gpu::DeviceSettings device_settings;
        device_settings.pipeline_cache_directory = "";
        device_ = value_of(gpu::Device::create(value_of(gpu::Instance::create(settings)), device_settings));
    }
    static void TearDownTestSuite() { device_.reset(); }
    void TearDown() override {
        expect_ok(device().wait_idle());
        for (const auto& message : device().validation_messages()) ADD_FAILURE() << message;
    }

    static gpu::Device& device() { return *device_; }
    const gpu::ComputePipeline& compute(const std::string& name) {
        return *value_of(pipelines.compute("shaders/" + name));
    }
    static gpu::ImageDescription square(const std::string& name) {
        return {.name = name, .format = VK_FORMAT_R32G32B32A32_SFLOAT, .extent = {side, side, 1}};
    }
    void add_fill(const std::string& name, ImageHandle target, float value) {
        graph.add_pass(
            name, PassKind::compute, [&](PassBuilder& p) { p.write(target, Usage::storage_write); },
            [this, target, value](PassContext& context) {
                context.commands.dispatch_threads(compute("fill.comp"), glm::vec4(value), {context.image(target)},
                                                  {side, side, 1});
            });
    }
    void add_half_fill(const std::string& name, ImageHandle target) {
        graph.add_pass(
            name, PassKind::compute, [&](PassBuilder& p) { p.write(target, Usage::storage_write); },
            [this, target](PassContext& context) {
                context.commands.dispatch_threads(compute("half_fill.comp"), gpu::NoPushConstants{},
                                                  {context.image(target)}, {side, side, 1});
            });
    }
    void add_sum(const std::string& name, ImageHandle source, ImageHandle target, float summand) {
        const VkSampler sampler = value_of(device().sampler(gpu::SamplerDescription::nearest_clamp()));
        graph.add_pass(
            name, PassKind::compute,
            [&](PassBuilder& p) { p.read(source, Usage::sampled).write(target, Usage::storage_write); },
            [this, source, target, summand, sampler](PassContext& context) {
                context.commands.dispatch_threads(compute("add.comp"), glm::vec4(summand),
                                                  {{context.image(source), sampler}, context.image(target)},
                                                  {side, side, 1});
            });
    }
    void run(Executor& executor, int frames = 1, gpu::Timestamps* timestamps = nullptr) {
        for (int frame = 0; frame < frames; ++frame) {
            if (timestamps) timestamps->begin_frame();
            auto commands = value_of(device().begin_commands("frame"));
            expect_ok(executor.execute(commands, timestamps));
            value_of(device().submit(std::move(commands)));
        }
    }
    glm::vec4 first_texel(const gpu::Image& image) { return value_of(device().read_back_as<glm::vec4>(image))[0]; }

    static constexpr std::uint32_t side = 32;
    gpu::Pipelines pipelines{*device_, gpu::ShaderLibrary(tests::embedded_shaders())};
    Graph graph;

private:
    static inline std::unique_ptr<gpu::Device> device_;
};

TEST_F(Execution, GivesTheRightPictureWithAliasedMemoryOverManyFrames) {
    std::vector<ImageHandle> chain;
    for (int i = 0; i < 6; ++i) chain.push_back(graph.create_image(square("step " + std::to_string(i))));
    graph.export_image(chain.back());
    add_fill("fill", chain[0], 1.0f);
    for (int i = 1; i < 6; ++i) add_sum("sum " + std::to_string(i), chain[i - 1], chain[i], static_cast<float>(i));
    for (const bool poison : {false, true}) {
        Executor executor(device(), {.poison = poison});
        expect_ok(executor.set_graph(graph));
        EXPECT_LT(executor.compiled().heaps[0].size, executor.compiled().unaliased_bytes);
        run(executor, 3);
        EXPECT_EQ(first_texel(executor.image(chain.back())), glm::vec4(16.0f));
    }
}

TEST_F(Execution, RecordsOneGraphBesideOthersAndBothAreAsIfAlone) {
    const auto chain = [&](int length, float first) {
        graph = {};
        std::vector<ImageHandle> images;
        for (int i = 0; i < length; ++i) images.push_back(graph.create_image(square("step " + std::to_string(i))));
        graph.export_image(images.back());
        add_fill("fill", images[0], first);
        for (int i = 1; i < length; ++i) add_sum("sum " + std::to_string(i), images[i - 1], images[i], 1.0f);
        return images.back();
    };
    for (const bool poison : {false, true}) {
        Executor shorter(device(), {.poison = poison}), longer(device(), {.poison = poison}), another(device());
        const ImageHandle of_shorter = chain(3, 10.0f);
        expect_ok(shorter.set_graph(graph));
        const ImageHandle of_longer = chain(7, 20.0f);
        expect_ok(longer.set_graph(graph));
        const ImageHandle of_another = chain(2, 30.0f);
        expect_ok(another.set_graph(graph));
        for (int frame = 0; frame < 3; ++frame) {
            auto commands = value_of(device().begin_commands("frame"));
            expect_ok(longer.begin(commands));
            expect_ok(shorter.execute(commands, nullptr, &longer));
            expect_ok(another.execute(commands, nullptr, &longer));
            longer.finish(commands);
            expect_ok(longer.begin(commands));  // and once more, beside one that goes on after it is done
            longer.finish(commands);
            expect_ok(shorter.begin(commands));
            expect_ok(longer.execute(commands, nullptr, &shorter));
            shorter.finish(commands);
            value_of(device().submit(std::move(commands)));
        }
        EXPECT_EQ(first_texel(shorter.image(of_shorter)), glm::vec4(12.0f));
        EXPECT_EQ(first_texel(longer.image(of_longer)), glm::vec4(26.0f));
        EXPECT_EQ(first_texel(another.image(of_another)), glm::vec4(31.0f));
    }
}

TEST_F(Execution, PoisonsMemoryThatAPassForgetsToWrite) {
    const ImageHandle half = graph.create_image(square("half")), result = graph.create_image(square("result"));
    graph.export_image(result);
    add_half_fill("half", half);
    add_sum("copy", half, result, 0.0f);
    Executor executor(device(), {.poison = true});
    expect_ok(executor.set_graph(graph));
    run(executor, 2);
    const auto texels = value_of(device().read_back_as<glm::vec4>(executor.image(result)));
    EXPECT_EQ(texels[0], glm::vec4(1.0f));
    EXPECT_TRUE(std::isnan(texels[side - 1].x)) << texels[side - 1].x;
}

TEST_F(Execution, PoisonsMemoryOfAPassThatWaitsWithAnEarlierOne) {
    std::vector<std::pair<ImageHandle, ImageHandle>> copies;
    for (const std::string name : {"first", "second"}) {
        const ImageHandle half = graph.create_image(square(name)), result = graph.create_image(square(name + " copied"));
        graph.export_image(result);
        add_half_fill(name, half);
        copies.emplace_back(half, result);
    }
    for (const auto& [half, result] : copies) add_sum("copy", half, result, 0.0f);
    Executor executor(device(), {.poison = true});
    expect_ok(executor.set_graph(graph));
    ASSERT_TRUE(executor.compiled().order[1].barriers.empty()) << "joined with those of the first";
    run(executor, 2);
    for (const auto& [half, result] : copies) {
        const auto texels = value_of(device().read_back_as<glm::vec4>(executor.image(result)));
        EXPECT_EQ(texels[0], glm::vec4(1.0f));
        EXPECT_TRUE(std::isnan(texels[side - 1].x)) << texels[side - 1].x;
    }
}

TEST_F(Execution, KeepsHistoriesFromFrameToFrame) {
    const auto history = graph.create_history(square("history"));
    graph.export_image(history.current);
    add_sum("accumulate", history.previous, history.current, 1.0f);
    Executor executor(device());
    expect_ok(executor.set_graph(graph));
    run(executor, 5);
    EXPECT_EQ(first_texel(executor.image(history.previous)), glm::vec4(5.0f)) << "from zero, one more each frame";
    executor.reset_history();
    run(executor, 2);
    EXPECT_EQ(first_texel(executor.image(history.previous)), glm::vec4(2.0f));

    // The same graph with one pass more keeps it.
    const ImageHandle extra = graph.create_image(square("extra"));
    graph.export_image(extra);
    add_fill("extra", extra, 7.0f);
    expect_ok(executor.set_graph(graph));
    run(executor, 2);
    EXPECT_EQ(first_texel(executor.image(history.previous)), glm::vec4(4.0f));
    EXPECT_EQ(first_texel(executor.image(extra)), glm::vec4(7.0f));
}

TEST_F(Execution, DispatchesAsManyGroupsAsAnEarlierPassCounted) {
    const BufferHandle counter = graph.create_persistent_buffer({.name = "counter", .size = 4});
    const BufferHandle groups = graph.create_buffer({.name = "groups", .size = 12});
    const BufferHandle tally = graph.create_persistent_buffer({.name = "tally", .size = 4});
    graph.export_buffer(tally, Usage::transfer_read);
    graph.add_pass(
        "count", PassKind::compute,
        [&](PassBuilder& p) { p.read_write(counter, Usage::storage_read_write).write(groups, Usage::storage_write); },
        [=, this](PassContext& context) {
            context.commands.dispatch(compute("count.comp"), gpu::NoPushConstants{},
                                      {context.buffer(counter), context.buffer(groups)}, {1, 1, 1});
        });
    graph.add_pass(
        "tally", PassKind::compute,
        [&](PassBuilder& p) { p.read(groups, Usage::indirect).read_write(tally, Usage::storage_read_write); },
        [=, this](PassContext& context) {
            context.commands.dispatch_indirect(compute("tally.comp"), gpu::NoPushConstants{}, {context.buffer(tally)},
                                               context.buffer(groups));
        });
    Executor executor(device(), {.poison = true});
    expect_ok(executor.set_graph(graph));
    run(executor, 4);
    EXPECT_EQ(value_of(device().read_back_as<std::uint32_t>(executor.buffer(tally)))[0], 1u + 2 + 3 + 4);
}

TEST_F(Execution, RastersAndComputesInTurnOnAnImportedImage) {
    const gpu::Image target = value_of(gpu::Image::create(device(), {.name = "target",
                                                                     .format = VK_FORMAT_R32G32B32A32_SFLOAT,
                                                                     .extent = {side, side, 1},
                                                                     .usage = VK_IMAGE_USAGE_STORAGE_BIT}));
    const ImageHandle drawn = graph.create_image(square("drawn"));
    const ImageHandle depth =
        graph.create_image({.name = "depth", .format = VK_FORMAT_D32_SFLOAT, .extent = {side, side, 1}});
    const ImageHandle output = graph.import_image(target.description());
    gpu::GraphicsDescription description;
    description.name = "fullscreen";
    description.vertex = "shaders/fullscreen.vert";
    description.fragment = "shaders/constant.frag";
    description.color_formats = {VK_FORMAT_R32G32B32A32_SFLOAT};
    description.depth_format = VK_FORMAT_D32_SFLOAT;
    description.cull_mode = VK_CULL_MODE_NONE;
    const gpu::GraphicsPipeline* pipeline = value_of(pipelines.graphics(description));
    const auto draw = [=](PassContext& context, VkAttachmentLoadOp load, float color) {
        gpu::Rendering rendering;
        rendering.color = {{.view = {&context.image(drawn)}, .load = load}};
        rendering.depth = gpu::DepthAttachment{.view = {&context.image(depth)}, .load = load};
        context.commands.begin_rendering(rendering);
        context.commands.bind(*pipeline, glm::vec4(color), {});
        context.commands.draw(3);
        context.commands.end_rendering();
    };
    graph.add_pass(
        "draw", PassKind::graphics,
        [&](PassBuilder& p) { p.write(drawn, Usage::color_attachment).write(depth, Usage::depth_attachment); },
        [=](PassContext& context) { draw(context, VK_ATTACHMENT_LOAD_OP_CLEAR, 2.0f); });
    // At the same depth nothing passes the test: the first colour stays.
    graph.add_pass(
        "draw behind", PassKind::graphics,
        [&](PassBuilder& p) {
            p.read_write(drawn, Usage::color_attachment).read_write(depth, Usage::depth_attachment);
        },
        [=](PassContext& context) { draw(context, VK_ATTACHMENT_LOAD_OP_LOAD, 9.0f); });
    add_sum("sum", drawn, output, 0.5f);

    Executor executor(device(), {.poison = true});
    expect_ok(executor.set_graph(graph));
    auto commands = value_of(device().begin_commands("unbound"));
    const auto unbound = executor.execute(commands);
    ASSERT_FALSE(unbound);
    EXPECT_EQ(unbound.error().text(), "pass 'sum': the imported 'target' is not bound");

    executor.bind(output, target);
    gpu::Timestamps timestamps = value_of(gpu::Timestamps::create(device()));
    run(executor, 3, &timestamps);
    EXPECT_EQ(first_texel(target), glm::vec4(2.5f, 2.5f, 2.5f, 2.5f));
    const gpu::FrameTimes times = value_of(timestamps.wait());
    ASSERT_EQ(times.scopes.size(), 3u);
    EXPECT_EQ(times.scopes[0].name, "draw");
    EXPECT_EQ(times.scopes[2].name, "sum");
    for (const auto& scope : times.scopes) EXPECT_GT(scope.milliseconds, 0.0) << scope.name;
}

TEST_F(Execution, ReportsAPassThatBindsTheWrongThing) {
    const ImageHandle image = graph.create_image(square("image"));
    graph.export_image(image);
    graph.add_pass(
        "broken", PassKind::compute, [&](PassBuilder& p) { p.write(image, Usage::storage_write); },
        [this](PassContext& context) {
            context.commands.dispatch(compute("fill.comp"), glm::vec4(0), {}, {1, 1, 1});
        });
    Executor executor(device());
    expect_ok(executor.set_graph(graph));
    auto commands = value_of(device().begin_commands("frame"));
    expect_ok(executor.execute(commands));
    const auto submitted = device().submit(std::move(commands));
    ASSERT_FALSE(submitted);
    EXPECT_EQ(submitted.error().text(),
              "pass 'broken', pipeline 'shaders/fill.comp': expected 1 bindings (0 'target'), found 0");
}

TEST_F(Execution, KeepsTheOldGraphWhenANewOneIsRefused) {
    const ImageHandle image = graph.create_image(square("image"));
    graph.export_image(image);
    add_fill("fill", image, 3.0f);
    Executor executor(device());
    expect_ok(executor.set_graph(graph));
    Graph wrong;
    const ImageHandle a = wrong.create_image(square("a"));
    wrong.add_pass("reader", PassKind::compute, [&](PassBuilder& p) { p.read(a, Usage::sampled).side_effect(); }, {});
    EXPECT_FALSE(executor.set_graph(wrong));
    run(executor);
    EXPECT_EQ(first_texel(executor.image(image)), glm::vec4(3.0f));
}

}  // namespace
}  // namespace heliodon::graph
