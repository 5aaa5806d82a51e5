// Damaged pictures: whatever the bytes, reading gives a picture of the size it says or one located error.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <random>

#include "core/image_io.h"
#include "sample_pictures.h"
#include "temporary_directory.h"

namespace heliodon {
namespace {

using tests::TemporaryDirectory;

class DamagedPicture : public ::testing::TestWithParam<const char*> {
protected:
    void SetUp() override {
        Picture picture;
        picture.image = tests::gradient(24, 18);
        picture.has_ev100 = true;
        if (ending() == ".exr") picture.layers = {{"depth", Image(24, 18, 1, 2.0f)}};
        ASSERT_TRUE(write_picture(path(), picture));
        whole_ = read_file(path()).value();
        ASSERT_TRUE(read_picture(path()));
    }
    [[nodiscard]] std::string ending() const { return GetParam(); }
    [[nodiscard]] std::filesystem::path path() const { return directory_ / ("picture" + ending()); }

    /// As read from a file with these bytes.
    Result<Picture> read(const std::string& bytes) const { return decode_picture(path(), bytes); }
    void expect_located(const Error& error) const {
        EXPECT_EQ(error.where, path().string());
        EXPECT_FALSE(error.message.empty());
        EXPECT_EQ(error.message.find('\n'), std::string::npos) << error.message;
    }
    /// Whole and consistent, or one located error.
    void expect_sound(const Result<Picture>& read) const {
        if (!read) return expect_located(read.error());
        const Image& image = read->image;
        EXPECT_GT(image.width, 0);
        EXPECT_GT(image.height, 0);
        EXPECT_EQ(image.pixels.size(), static_cast<std::size_t>(image.width) * image.height * image.channels);
    }

    TemporaryDirectory directory_;
    std::string whole_;
};

TEST_P(DamagedPicture, TruncatedAnywhereIsALocatedError) {
    for (std::size_t length = 0; length < whole_.size(); length += length < 600 ? 1 : 37) {
        const Result<Picture> picture = read(whole_.substr(0, length));
        ASSERT_FALSE(picture) << "at " << length << " of " << whole_.size() << " bytes";
        expect_located(picture.error());
    }
    EXPECT_FALSE(read(whole_.substr(0, whole_.size() - 1)));
}

TEST_P(DamagedPicture, WithFlippedBytesIsAPictureOrALocatedError) {
    std::mt19937 generator(20);
    for (int trial = 0; trial < 1500; ++trial) {
        std::string bytes = whole_;
        const int flips = 1 + static_cast<int>(generator() % 4);
        // Half of the trials aim at the header, where the sizes are.
        const std::size_t range = trial % 2 == 0 ? std::min<std::size_t>(bytes.size(), 500) : bytes.size();
        for (int i = 0; i < flips; ++i) bytes[generator() % range] = static_cast<char>(generator());
        expect_sound(read(bytes));
    }
}

TEST_P(DamagedPicture, WithBytesMissingOrInsertedInTheMiddleIsAPictureOrALocatedError) {
    std::mt19937 generator(21);
    for (int trial = 0; trial < 300; ++trial) {
        const std::size_t at = generator() % whole_.size(), count = 1 + generator() % 40;
        expect_sound(read(whole_.substr(0, at) + whole_.substr(std::min(at + count, whole_.size()))));
        expect_sound(
            read(whole_.substr(0, at) + std::string(count, static_cast<char>(generator())) + whole_.substr(at)));
    }
}

TEST_P(DamagedPicture, ThatIsGarbageIsALocatedError) {
    std::mt19937 generator(22);
    for (int trial = 0; trial < 100; ++trial) {
        std::string bytes(1 + generator() % 2000, '\0');
        for (char& c : bytes) c = static_cast<char>(generator());
        const Result<Picture> picture = read(bytes);
        ASSERT_FALSE(picture);
        expect_located(picture.error());
    }
}

TEST_P(DamagedPicture, ThatIsAPictureOfAnotherFormatIsALocatedError) {
    for (const char* other : {".exr", ".hdr", ".pfm", ".png", ".jpg"}) {
        if (other == ending()) continue;
        Picture picture;
        picture.image = tests::gradient(8, 8);
        const std::filesystem::path other_path = directory_ / (std::string("other") + other);
        ASSERT_TRUE(write_picture(other_path, picture));
        const Result<Picture> wrong = read(read_file(other_path).value());
        ASSERT_FALSE(wrong) << other;
        expect_located(wrong.error());
    }
}

INSTANTIATE_TEST_SUITE_P(Formats, DamagedPicture, ::testing::Values(".exr", ".hdr", ".pfm", ".png", ".jpg"),
                         [](const auto& info) { return std::string(info.param).substr(1); });

TEST(DisplayContainers, OfOtherFormatsPass) {
    EXPECT_TRUE(check_display_picture("BM a bitmap"));
    EXPECT_TRUE(check_display_picture(""));
}

// stb 2.27 writes past its table of code sizes when the counts of a Huffman table add up to more than 256.
TEST(DisplayContainers, WithUnlawfulHuffmanTablesAreRefused) {
    const TemporaryDirectory directory;
    Picture picture;
    picture.image = tests::gradient(16, 16);
    ASSERT_TRUE(write_picture(directory / "a.jpg", picture));
    std::string bytes = read_file(directory / "a.jpg").value();
    ASSERT_TRUE(check_display_picture(bytes));
    const std::size_t table = bytes.find("\xff\xc4");
    ASSERT_NE(table, std::string::npos);
    bytes.replace(table + 5, 16, std::string(16, '\xff'));
    const Result<Picture> read = decode_picture("a.jpg", bytes);
    ASSERT_FALSE(read);
    EXPECT_NE(read.error().message.find("Huffman"), std::string::npos) << read.error().text();
}

/// Text with a size in it, in a file far too small for that size.
struct AbsurdHeader {
    const char* name;
    std::string bytes;
};

TEST(AbsurdSizes, AreRefusedBeforeAnythingIsAllocated) {
    const TemporaryDirectory directory;
    const std::string radiance = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n";
    const AbsurdHeader headers[] = {
        {"huge.pfm", "PF\n65536 65536\n-1.0\n"},
        {"beyond.pfm", "PF\n2147483647 2147483647\n-1.0\n"},
        {"overflow.pfm", "PF\n99999999999999999999 1\n-1.0\n"},
        {"negative.pfm", "PF\n-4 4\n-1.0\n"},
        {"zero.pfm", "PF\n0 0\n-1.0\n"},
        {"huge.hdr", radiance + "-Y 65536 +X 65536\n"},
        {"beyond.hdr", radiance + "-Y 2000000000 +X 2000000000\n"},
        {"negative.hdr", radiance + "-Y -1 +X 8\n"},
        {"zero.hdr", radiance + "-Y 0 +X 0\n"},
    };
    for (const AbsurdHeader& header : headers) {
        std::ofstream(directory / header.name, std::ios::binary) << header.bytes;
        const Result<Picture> read = read_picture(directory / header.name);
        ASSERT_FALSE(read) << header.name;
        EXPECT_EQ(read.error().where, (directory / header.name).string());
    }
}

TEST(AbsurdSizes, InAnExrHeaderAreRefused) {
    const TemporaryDirectory directory;
    Picture picture;
    picture.image = Image(16, 16, 3, 1.0f);
    ASSERT_TRUE(write_picture(directory / "a.exr", picture));
    const std::string whole = read_file(directory / "a.exr").value();
    const std::size_t window = whole.find(std::string("dataWindow\0box2i\0", 17));
    ASSERT_NE(window, std::string::npos);
    const std::size_t corner = window + 17 + 4 + 8;  // past the attribute's length and the first corner
    for (const std::string& size :
         {std::string("\xff\xff\x00\x00\xff\xff\x00\x00", 8), std::string("\xff\xff\xff\x7f\xff\xff\xff\x7f", 8),
          std::string("\xff\xff\xff\xff\xff\xff\xff\xff", 8), std::string("\x0f\x00\x00\x00\xff\xff\x00\x00", 8)}) {
        std::string bytes = whole;
        bytes.replace(corner, size.size(), size);
        std::ofstream(directory / "b.exr", std::ios::binary) << bytes;
        const Result<Picture> read = read_picture(directory / "b.exr");
        ASSERT_FALSE(read);
        EXPECT_EQ(read.error().where, (directory / "b.exr").string());
    }
}

}  // namespace
}  // namespace heliodon
