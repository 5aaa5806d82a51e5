#include <algorithm>
#include <numeric>

#include "gpu_test.h"
#include "shaders/multiply_add_shared.h"

namespace heliodon::gpu {
namespace {

class Compute : public GpuTest {
protected:
    static std::vector<std::uint32_t> counting(std::uint32_t count) {
        std::vector<std::uint32_t> values(count);
        std::iota(values.begin(), values.end(), 0u);
        return values;
    }
    /// The error of commands that should not have been recorded.
    static std::string refused(const std::function<void(Commands&)>& record) {
        auto commands = value_of(device().begin_commands("refused"));
        record(commands);
        const auto submitted = device().submit(std::move(commands));
        return submitted ? "" : submitted.error().text();
    }
};

TEST_F(Compute, MultipliesAndAdds) {
    constexpr std::uint32_t count = 1000;
    const auto input = counting(count);
    const Buffer source = buffer("source", count * 4), target = buffer("target", count * 4);
    expect_ok(device().upload(source, std::span<const std::uint32_t>(input)));
    expect_ok(device().run("multiply", [&](Commands& commands) {
        commands.dispatch_threads(compute("multiply_add.comp"), MultiplyAdd{count, 3, 7}, {source, target},
                                  {count, 1, 1});
    }));
    const auto output = value_of(device().read_back_as<std::uint32_t>(target));
    for (std::uint32_t i = 0; i < count; ++i) ASSERT_EQ(output[i], 3 * i + 7);
}

TEST_F(Compute, ReflectionKnowsTheInterface) {
    const ComputePipeline& pipeline = compute("multiply_add.comp");
    EXPECT_EQ(pipeline.workgroup_size()[0], 64u);
    EXPECT_EQ(pipeline.layout().push_constant_bytes(), sizeof(MultiplyAdd));
    ASSERT_EQ(pipeline.layout().bindings().size(), 2u);
    EXPECT_EQ(pipeline.layout().bindings()[0].name, "source");
    EXPECT_EQ(pipeline.layout().bindings()[1].name, "target");
    EXPECT_EQ(pipeline.layout().bindings()[1].type, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER);
}

TEST_F(Compute, RefusesPushConstantsOfAnotherSize) {
    const Buffer source = buffer("source", 64), target = buffer("target", 64);
    const std::string error = refused([&](Commands& commands) {
        commands.dispatch(compute("multiply_add.comp"), std::array<std::uint32_t, 2>{1, 2}, {source, target},
                          {1, 1, 1});
    });
    EXPECT_EQ(error, "pipeline 'shaders/multiply_add.comp': expected 12 bytes of push constants, found 8");
}

TEST_F(Compute, RefusesAMissingBindingByName) {
    const Buffer source = buffer("source", 64);
    const std::string error = refused([&](Commands& commands) {
        commands.begin_label("multiply");
        commands.dispatch(compute("multiply_add.comp"), MultiplyAdd{}, {source}, {1, 1, 1});
        commands.end_label();
    });
    EXPECT_EQ(error,
              "pass 'multiply', pipeline 'shaders/multiply_add.comp': expected 2 bindings (0 'source', 1 'target'), "
              "found 1");
}

TEST_F(Compute, RefusesABindingOfTheWrongKindByName) {
    const Buffer source = buffer("source", 64);
    const Image image = value_of(Image::create(device(), {.name = "picture", .extent = {4, 4, 1}}));
    const std::string error = refused([&](Commands& commands) {
        commands.dispatch(compute("multiply_add.comp"), MultiplyAdd{}, {source, image}, {1, 1, 1});
    });
    EXPECT_EQ(error,
              "pipeline 'shaders/multiply_add.comp': binding 1 'target' is a storage buffer, but an image was given");
    const std::string storage = refused([&](Commands& commands) {
        commands.dispatch(compute("write_mip.comp"), glm::vec4(1), {image}, {1, 1, 1});
    });
    EXPECT_EQ(storage,
              "pipeline 'shaders/write_mip.comp': binding 0 'target' is a storage image, but image 'picture' was "
              "not created as one");
}

TEST_F(Compute, SpecializesConstantsAndTheWorkgroupSize) {
    const ComputePipeline& pipeline = compute("work.comp", {{0, 32}, {1, 2}});
    EXPECT_EQ(pipeline.workgroup_size()[0], 32u);
    const Buffer values = buffer("values", 64 * 4);
    expect_ok(device().run("work", [&](Commands& commands) {
        commands.dispatch_threads(pipeline, NoPushConstants{}, {values}, {64, 1, 1});
    }));
    const auto output = value_of(device().read_back_as<std::uint32_t>(values));
    for (std::uint32_t i = 0; i < 64; ++i) ASSERT_EQ(output[i], (i * 1664525u + 1013904223u) * 1664525u + 1013904223u);
}

TEST_F(Compute, ReadsItsGroupCountFromABuffer) {
    const ComputePipeline& pipeline = compute("work.comp", {{0, 16}});
    const Buffer values = buffer("values", 64 * 4),
                 arguments = buffer("arguments", 12, VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT);
    const std::vector<std::uint32_t> groups = {2, 1, 1}, zeros(64, 0);
    expect_ok(device().upload(arguments, std::span<const std::uint32_t>(groups)));
    expect_ok(device().upload(values, std::span<const std::uint32_t>(zeros)));
    expect_ok(device().run("work", [&](Commands& commands) {
        commands.dispatch_indirect(pipeline, NoPushConstants{}, {values}, arguments);
    }));
    const auto output = value_of(device().read_back_as<std::uint32_t>(values));
    EXPECT_EQ(output[31], 31 * 1664525u + 1013904223u);
    EXPECT_EQ(output[32], 0u);
}

TEST_F(Compute, UploadsAndReadsBackMoreThanTheStagingRing) {
    const auto input = counting(24u << 20 >> 1);  // 48 MiB: as much as the ring's three blocks
    const Buffer target = buffer("large", input.size() * 4);
    expect_ok(device().upload(target, std::span<const std::uint32_t>(input)));
    const std::vector<std::uint32_t> patch = {42, 43};
    expect_ok(device().upload(target, std::span<const std::uint32_t>(patch), 4));
    const auto output = value_of(device().read_back_as<std::uint32_t>(target));
    EXPECT_EQ(output[0], 0u);
    EXPECT_EQ(output[1], 42u);
    EXPECT_EQ(output[2], 43u);
    EXPECT_TRUE(std::equal(output.begin() + 3, output.end(), input.begin() + 3));
}

TEST_F(Compute, RefusesAnUploadThatDoesNotFit) {
    const Buffer target = buffer("small", 8);
    const std::vector<std::uint32_t> values(3);
    const auto uploaded = device().upload(target, std::span<const std::uint32_t>(values));
    ASSERT_FALSE(uploaded);
    EXPECT_EQ(uploaded.error().where, "buffer 'small'");
}

TEST_F(Compute, RefusesABufferLargerThanTheDeviceAllows) {
    const auto huge = Buffer::create(device(), {"huge", VkDeviceSize{1} << 50, 0, BufferMemory::device});
    ASSERT_FALSE(huge);
    EXPECT_EQ(huge.error().where, "buffer 'huge' of 1125899906842624 bytes");
    EXPECT_NE(huge.error().message.find("allows no buffer of more than"), std::string::npos) << huge.error().message;
}

TEST_F(Compute, SamplesTexturesBySlotAndTheDefaultElsewhere) {
    BindlessTextures& textures = device().textures();
    const std::uint32_t used = textures.used();
    std::vector<Image> images;
    std::vector<std::uint32_t> slots;
    for (const std::uint8_t red : {51, 102}) {
        images.push_back(value_of(Image::create(device(), {.name = "texture", .extent = {1, 1, 1}})));
        const std::array texel = {std::byte{red}, std::byte{0}, std::byte{0}, std::byte{255}};
        expect_ok(device().upload(images.back(), texel));
        slots.push_back(value_of(textures.add(images.back(), VK_NULL_HANDLE)));
    }
    EXPECT_EQ(textures.used(), used + 2);
    slots.push_back(textures.capacity() - 1);
    const Buffer colors = buffer("colors", 3 * 16), slot_buffer = buffer("slots", 12);
    expect_ok(device().upload(slot_buffer, std::span<const std::uint32_t>(slots)));
    const auto sample = [&] {
        expect_ok(device().run("sample", [&](Commands& commands) {
            commands.dispatch(compute("sample_textures.comp"), NoPushConstants{}, {colors, slot_buffer}, {3, 1, 1});
        }));
        return value_of(device().read_back_as<glm::vec4>(colors));
    };
    auto seen = sample();
    EXPECT_NEAR(seen[0].r, 0.2f, 1e-6f);
    EXPECT_NEAR(seen[1].r, 0.4f, 1e-6f);
    EXPECT_EQ(seen[2], glm::vec4(1));

    expect_ok(textures.replace(slots[0], images[1], VK_NULL_HANDLE));
    textures.remove(slots[1]);
    EXPECT_EQ(textures.used(), used + 1);
    seen = sample();
    EXPECT_NEAR(seen[0].r, 0.4f, 1e-6f);
    EXPECT_EQ(seen[1], glm::vec4(1)) << "a removed slot holds the default again";
    textures.remove(slots[0]);
}

TEST_F(Compute, BindsMoreResourcesThanCanBePushed) {
    const ComputePipeline& pipeline = compute("many_buffers.comp");
    EXPECT_FALSE(pipeline.layout().push_descriptors());
    std::vector<Buffer> buffers;
    std::vector<Binding> bindings;
    for (std::uint32_t i = 0; i < 40; ++i) {
        buffers.push_back(buffer("value", 4));
        const std::vector<std::uint32_t> value = {i};
        expect_ok(device().upload(buffers.back(), std::span<const std::uint32_t>(value)));
    }
    for (const Buffer& value : buffers) bindings.emplace_back(value);
    expect_ok(device().run("many", [&](Commands& commands) {
        for (std::uint32_t i = 0; i < 300; ++i) {  // more sets than one descriptor pool holds
            commands.dispatch(pipeline, 1u, Bindings(bindings), {1, 1, 1});
            commands.compute_barrier();
        }
    }));
    EXPECT_EQ(value_of(device().read_back_as<std::uint32_t>(buffers[39]))[0], 39u + 300u);
}

TEST_F(Compute, IsTimedByScope) {
    Timestamps timestamps = value_of(Timestamps::create(device()));
    const Buffer values = buffer("values", 4096 * 4);
    const auto frame = [&](std::uint32_t rounds, Timestamps::Detail detail = Timestamps::Detail::scopes) {
        timestamps.begin_frame(detail);
        auto commands = value_of(device().begin_commands("timed"));
        const std::uint32_t first = timestamps.begin(commands, "short");
        commands.dispatch_threads(compute("work.comp", {{0, 64}, {1, 1}}), NoPushConstants{}, {values}, {4096, 1, 1});
        timestamps.end(commands, first);
        commands.compute_barrier();
        const std::uint32_t second = timestamps.begin(commands, "long");
        commands.dispatch_threads(compute("work.comp", {{0, 64}, {1, rounds}}), NoPushConstants{}, {values},
                                  {4096, 1, 1});
        timestamps.end(commands, second);
        timestamps.end_frame(commands);
        return value_of(device().submit(std::move(commands)));
    };
    frame(20000);
    const FrameTimes waited = value_of(timestamps.wait());
    ASSERT_EQ(waited.scopes.size(), 2u);
    EXPECT_EQ(waited.scopes[0].name, "short");
    EXPECT_EQ(waited.scopes[1].name, "long");
    EXPECT_GT(waited.scopes[1].milliseconds, waited.scopes[0].milliseconds);
    EXPECT_GE(waited.total_milliseconds, waited.scopes[0].milliseconds + waited.scopes[1].milliseconds - 1e-6);

    frame(20000, Timestamps::Detail::whole);
    const FrameTimes whole = value_of(timestamps.wait());
    ASSERT_EQ(whole.scopes.size(), 1u) << "the frame's own time, without its parts";
    EXPECT_EQ(whole.scopes[0].name, "frame");
    EXPECT_GT(whole.total_milliseconds, waited.scopes[0].milliseconds);

    TimelineValue last = 0;
    for (int i = 0; i < 6; ++i) last = frame(10);
    expect_ok(device().wait(last));
    EXPECT_EQ(timestamps.latest().frame, 8u);
}

}  // namespace
}  // namespace heliodon::gpu
