#include "core/image_io.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>

#include "core/units.h"
#include "sample_pictures.h"
#include "temporary_directory.h"

namespace heliodon {
namespace {

using tests::TemporaryDirectory;

Picture picture_of(Image image) {
    Picture picture;
    picture.image = std::move(image);
    return picture;
}

Picture round_trip(const std::filesystem::path& path, const Picture& picture) {
    const Result<void> written = write_picture(path, picture);
    EXPECT_TRUE(written) << written.error().text();
    Result<Picture> read = read_picture(path);
    EXPECT_TRUE(read) << read.error().text();
    return read ? *std::move(read) : Picture{};
}

void expect_same(const Image& a, const Image& b) {
    ASSERT_EQ(a.width, b.width);
    ASSERT_EQ(a.height, b.height);
    ASSERT_EQ(a.channels, b.channels);
    EXPECT_EQ(a.pixels, b.pixels);
}

const Layer* find_layer(const Picture& picture, const std::string& name) {
    for (const Layer& layer : picture.layers) {
        if (layer.name == name) return &layer;
    }
    return nullptr;
}

TEST(Exr, KeepsEveryBitOfThePictureItsLayersAndItsExposure) {
    const TemporaryDirectory directory;
    Picture picture = picture_of(tests::hdr_noise(37, 23, 3, 1));
    picture.image.at(3, 4, 1) = -2.5f;
    picture.ev100 = 9.25f;
    picture.has_ev100 = true;
    picture.layers = {{"albedo", tests::unit_noise(37, 23, 3, 2)},
                      {"depth", tests::hdr_noise(37, 23, 1, 3)},
                      {"normal", tests::unit_noise(37, 23, 3, 4)},
                      {"coverage", tests::unit_noise(37, 23, 1, 5)},
                      {"motion", tests::unit_noise(37, 23, 2, 6)}};
    const Picture read = round_trip(directory / "picture.exr", picture);
    expect_same(read.image, picture.image);
    EXPECT_TRUE(read.has_ev100);
    EXPECT_EQ(read.ev100, 9.25f);
    ASSERT_EQ(read.layers.size(), picture.layers.size());
    for (const Layer& layer : picture.layers) {
        const Layer* found = find_layer(read, layer.name);
        ASSERT_NE(found, nullptr) << layer.name;
        expect_same(found->image, layer.image);
    }
}

TEST(Exr, NamesChannelsAsOtherProgramsExpectThem) {
    const TemporaryDirectory directory;
    Picture picture = picture_of(Image(2, 2, 4, 1.0f));
    picture.layers = {{"albedo", Image(2, 2, 3)}, {"depth", Image(2, 2, 1)}, {"normal", Image(2, 2, 3)}};
    ASSERT_TRUE(write_picture(directory / "a.exr", picture));
    const std::string bytes = read_file(directory / "a.exr").value();
    for (const char* name :
         {"albedo.R", "albedo.G", "albedo.B", "depth.Z", "normal.X", "normal.Y", "normal.Z", "whiteLuminance"}) {
        EXPECT_NE(bytes.find(std::string(name) + '\0'), std::string::npos) << name;
    }
    EXPECT_EQ(bytes.find("ev100"), std::string::npos) << "no exposure was given";
}

TEST(Exr, RoundTripsGreyAndAlphaPictures) {
    const TemporaryDirectory directory;
    for (const int channels : {1, 3, 4}) {
        const Picture picture = picture_of(tests::hdr_noise(5, 40, channels, 7));
        expect_same(round_trip(directory / "a.exr", picture).image, picture.image);
    }
}

TEST(Exr, RefusesLayersOfAnotherSizeOrOfOneName) {
    const TemporaryDirectory directory;
    Picture picture = picture_of(Image(4, 4, 3));
    picture.layers = {{"albedo", Image(4, 5, 3)}};
    Result<void> written = write_picture(directory / "a.exr", picture);
    ASSERT_FALSE(written);
    EXPECT_NE(written.error().message.find("4x5"), std::string::npos) << written.error().text();
    picture.layers = {{"albedo", Image(4, 4, 3)}, {"albedo", Image(4, 4, 3)}};
    written = write_picture(directory / "a.exr", picture);
    ASSERT_FALSE(written);
    EXPECT_NE(written.error().message.find("albedo.R"), std::string::npos) << written.error().text();
    EXPECT_EQ(directory.entry_count(), 0u);
}

TEST(Pfm, KeepsEveryBit) {
    const TemporaryDirectory directory;
    for (const int channels : {1, 3}) {
        const Picture picture = picture_of(tests::hdr_noise(17, 9, channels, 8));
        expect_same(round_trip(directory / "a.pfm", picture).image, picture.image);
    }
}

TEST(Pfm, ReadsBigEndianValuesFromTheBottomRowUp) {
    const TemporaryDirectory directory;
    std::ofstream(directory / "a.pfm", std::ios::binary) << "Pf\n1 2\n1.0\n"
                                                         << std::string("\x3f\x80\x00\x00\x40\x00\x00\x00", 8);
    const Result<Picture> read = read_picture(directory / "a.pfm");
    ASSERT_TRUE(read) << read.error().text();
    EXPECT_EQ(read->image.at(0, 0), 2.0f);
    EXPECT_EQ(read->image.at(0, 1), 1.0f);
}

TEST(Hdr, KeepsEachPixelWithinHalfAStepOfItsSharedExponent) {
    const TemporaryDirectory directory;
    Picture picture = picture_of(tests::hdr_noise(33, 12, 3, 9));
    picture.image.at(0, 0, 0) = picture.image.at(0, 0, 1) = picture.image.at(0, 0, 2) = 0.0f;
    const Picture read = round_trip(directory / "a.hdr", picture);
    ASSERT_EQ(read.image.pixels.size(), picture.image.pixels.size());
    for (int y = 0; y < 12; ++y) {
        for (int x = 0; x < 33; ++x) {
            const glm::vec3 expected = picture.image.rgb(x, y), found = read.image.rgb(x, y);
            const float highest = std::max({expected.r, expected.g, expected.b});
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], highest / 255.0f);
        }
    }
}

TEST(Hdr, ReadsRunLengthCodedRowsAndDividesByTheExposure) {
    const TemporaryDirectory directory;
    std::string bytes = "#?RADIANCE\n# a comment\nEXPOSURE= 2.0\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 8\n";
    bytes += std::string("\x02\x02\x00\x08", 4);
    bytes += std::string("\x88\x80", 2);                              // R: 8 × 128
    bytes += std::string("\x08\x00\x10\x20\x30\x40\x50\x60\x70", 9);  // G: eight literals
    bytes += std::string("\x84\x00\x84\x80", 4);                      // B: two runs
    bytes += std::string("\x88\x81", 2);                              // E: 129
    std::ofstream(directory / "a.hdr", std::ios::binary) << bytes;
    const Result<Picture> read = read_picture(directory / "a.hdr");
    ASSERT_TRUE(read) << read.error().text();
    EXPECT_FLOAT_EQ(read->image.at(7, 0, 0), 0.5f);  // 128 · 2^(129−136) / 2
    EXPECT_FLOAT_EQ(read->image.at(7, 0, 1), 0x70 / 256.0f);
    EXPECT_FLOAT_EQ(read->image.at(3, 0, 2), 0.0f);
    EXPECT_FLOAT_EQ(read->image.at(4, 0, 2), 0.5f);
}

TEST(Hdr, ClampsWhatItCannotHold) {
    const TemporaryDirectory directory;
    Picture picture = picture_of(Image(1, 1, 3));
    picture.image.pixels = {std::numeric_limits<float>::infinity(), -1.0f, std::numeric_limits<float>::quiet_NaN()};
    const Picture read = round_trip(directory / "a.hdr", picture);
    EXPECT_GT(read.image.at(0, 0, 0), 1e38f);
    EXPECT_EQ(read.image.at(0, 0, 1), 0.0f);
    EXPECT_EQ(read.image.at(0, 0, 2), 0.0f);
}

TEST(Png, HoldsDisplayValuesInEightBitsAndReadsThemAsLinearLight) {
    const TemporaryDirectory directory;
    for (const int channels : {1, 2, 3, 4}) {
        const Picture picture = picture_of(tests::unit_noise(31, 17, channels, 10));
        const Picture read = round_trip(directory / "a.png", picture);
        ASSERT_EQ(read.image.channels, channels);
        ASSERT_EQ(read.image.pixels.size(), picture.image.pixels.size());
        for (std::size_t i = 0; i < read.image.pixels.size(); ++i) {
            const bool alpha = channels % 2 == 0 && static_cast<int>(i % channels) == channels - 1;
            const float display = std::round(picture.image.pixels[i] * 255.0f) / 255.0f;
            EXPECT_FLOAT_EQ(read.image.pixels[i], alpha ? display : units::srgb_decode(display));
        }
    }
}

// Two pixels of grey and alpha with 16 bits each: (0x8000, 0x1234) and (0xffff, 0xffff).
TEST(Png, ReadsSixteenBits) {
    const std::string bytes(
        "\x89\x50\x4e\x47\x0d\x0a\x1a\x0a\x00\x00\x00\x0d\x49\x48\x44\x52\x00\x00\x00\x02\x00\x00\x00\x01\x10"
        "\x04\x00\x00\x00\x0e\xbb\x6b\x42\x00\x00\x00\x0f\x49\x44\x41\x54\x78\x9c\x63\x68\x60\x10\x32\xf9\x0f"
        "\x04\x00\x0f\x6f\x04\xc3\x22\xc1\xc5\x19\x00\x00\x00\x00\x49\x45\x4e\x44\xae\x42\x60\x82",
        72);
    const Result<Picture> read = decode_picture("a.png", bytes);
    ASSERT_TRUE(read) << read.error().text();
    ASSERT_EQ(read->image.channels, 2);
    EXPECT_FLOAT_EQ(read->image.at(0, 0, 0), units::srgb_decode(32768.0f / 65535.0f));
    EXPECT_FLOAT_EQ(read->image.at(0, 0, 1), 4660.0f / 65535.0f);
    EXPECT_EQ(read->image.at(1, 0, 0), 1.0f);
    EXPECT_EQ(read->image.at(1, 0, 1), 1.0f);
}

TEST(Png, ClipsValuesOutsideTheDisplayRange) {
    const TemporaryDirectory directory;
    Picture picture = picture_of(Image(1, 1, 3));
    picture.image.pixels = {7.0f, -3.0f, std::numeric_limits<float>::quiet_NaN()};
    EXPECT_EQ(round_trip(directory / "a.png", picture).image.pixels, (std::vector<float>{1.0f, 0.0f, 0.0f}));
}

TEST(Jpeg, KeepsASmoothPictureWithinItsQuality) {
    const TemporaryDirectory directory;
    const Picture picture = picture_of(tests::gradient(64, 48));
    for (const char* name : {"a.jpg", "b.jpeg", "c.JPG"}) {
        const Picture read = round_trip(directory / name, picture);
        ASSERT_EQ(read.image.pixels.size(), picture.image.pixels.size());
        for (std::size_t i = 0; i < read.image.pixels.size(); ++i) {
            EXPECT_NEAR(units::srgb_encode(read.image.pixels[i]), picture.image.pixels[i], 0.04f);
        }
    }
}

TEST(Pictures, EndingsTellDisplayFromMeasuredFormats) {
    for (const char* name : {"a.png", "a.jpg", "a.JPEG"}) EXPECT_TRUE(is_display_format(name)) << name;
    for (const char* name : {"a.exr", "a.hdr", "a.pfm", "a.txt", "a"}) EXPECT_FALSE(is_display_format(name)) << name;
}

TEST(Pictures, AnUnknownEndingIsNamedBeforeAnyWork) {
    const TemporaryDirectory directory;
    for (const char* name : {"a.bmp", "a"}) {
        const std::filesystem::path path = directory / name;
        for (const Error& error :
             {check_writable(path).error(), write_picture(path, picture_of(Image(1, 1, 3))).error(),
              read_picture(path).error()}) {
            EXPECT_EQ(error.where, path.string());
            EXPECT_NE(error.message.find(".exr"), std::string::npos);
        }
    }
}

TEST(Pictures, AMissingFileADirectoryAndAnEmptyFileAreOneLocatedErrorEach) {
    const TemporaryDirectory directory;
    std::filesystem::create_directory(directory / "folder.png");
    std::ofstream(directory / "empty.exr");
    for (const char* name : {"missing.exr", "folder.png", "empty.exr"}) {
        const Result<Picture> read = read_picture(directory / name);
        ASSERT_FALSE(read) << name;
        EXPECT_EQ(read.error().where, (directory / name).string());
        EXPECT_FALSE(read.error().message.empty());
    }
}

TEST(Pictures, WhatHasNoPixelsIsNotWritten) {
    const TemporaryDirectory directory;
    Picture short_of_values = picture_of(Image(4, 4, 3));
    short_of_values.image.pixels.pop_back();
    for (const Picture& picture : {picture_of(Image(0, 0, 3)), picture_of(Image(4, 0, 3)), short_of_values}) {
        for (const char* name : {"a.exr", "a.hdr", "a.pfm", "a.png", "a.jpg"}) {
            EXPECT_FALSE(write_picture(directory / name, picture)) << name;
        }
    }
    EXPECT_EQ(directory.entry_count(), 0u);
}

}  // namespace
}  // namespace heliodon
