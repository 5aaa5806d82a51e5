#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <fstream>

#include "core/image_io.h"
#include "sample_pictures.h"
#include "temporary_directory.h"

namespace heliodon {
namespace {

using tests::TemporaryDirectory;

TEST(Files, ReadBackExactlyWhatWasWritten) {
    const TemporaryDirectory directory;
    std::string bytes(100'001, '\0');
    for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<char>(i * 31 >> 3);
    for (const std::string& content : {bytes, std::string(), std::string("\0\n\r", 3)}) {
        ASSERT_TRUE(write_file_atomically(directory / "file", content));
        EXPECT_EQ(read_file(directory / "file").value(), content);
        EXPECT_EQ(directory.entry_count(), 1u);
    }
}

TEST(Files, WhoseSizeIsUnknownAreReadToTheirEnd) {
    const Result<std::string> read = read_file("/proc/self/status");
    ASSERT_TRUE(read) << read.error().text();
    EXPECT_NE(read->find("Name:"), std::string::npos);
}

TEST(Files, NamesAtTheFileSystemsLimitCanBeWritten) {
    const TemporaryDirectory directory;
    EXPECT_TRUE(write_file_atomically(directory / std::string(255, 'n'), "x"));
}

TEST(Files, BehindALinkAreReplacedAndTheLinkStays) {
    const TemporaryDirectory directory;
    ASSERT_TRUE(write_file_atomically(directory / "file", "old"));
    std::filesystem::create_symlink("file", directory / "link");
    ASSERT_TRUE(write_file_atomically(directory / "link", "new"));
    EXPECT_TRUE(std::filesystem::is_symlink(directory / "link"));
    EXPECT_EQ(read_file(directory / "file").value(), "new");
    EXPECT_EQ(directory.entry_count(), 2u);
}

TEST(Files, ThatAreDevicesStayDevices) {
    ASSERT_TRUE(check_directory_writable("/dev/null"));
    ASSERT_TRUE(write_file_atomically("/dev/null", "x"));
    EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
    EXPECT_FALSE(write_file_atomically("/dev/full", "x"));
    EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
}

TEST(Writing, IntoAMissingDirectoryFailsAndNamesTheFile) {
    const TemporaryDirectory directory;
    const std::filesystem::path path = directory / "missing/picture.exr";
    for (const Error& error : {check_writable(path).error(), write_file_atomically(path, "x").error()}) {
        EXPECT_EQ(error.where, path.string());
        EXPECT_FALSE(error.message.empty());
    }
    EXPECT_EQ(directory.entry_count(), 0u);
}

TEST(Writing, BelowAFileOrOverADirectoryFails) {
    const TemporaryDirectory directory;
    ASSERT_TRUE(write_file_atomically(directory / "file", "x"));
    std::filesystem::create_directory(directory / "folder.png");
    for (const char* name : {"file/picture.png", "folder.png"}) {
        EXPECT_FALSE(check_writable(directory / name)) << name;
        EXPECT_FALSE(write_file_atomically(directory / name, "x")) << name;
    }
    EXPECT_EQ(directory.entry_count(), 2u);
}

TEST(Writing, IntoAReadOnlyDirectoryFails) {
    const std::filesystem::path path = "/proc/self/picture.png";  // read-only even for root
    EXPECT_FALSE(write_file_atomically(path, "x"));
    EXPECT_FALSE(write_picture(path, Picture{Image(1, 1, 3), {}, 0, false}));
}

TEST(Writing, CheckWritableAcceptsWhatThenSucceeds) {
    const TemporaryDirectory directory;
    EXPECT_TRUE(check_writable(directory / "picture.exr"));
    EXPECT_TRUE(check_writable("picture-in-the-working-directory.exr"));
    EXPECT_TRUE(check_directory_writable(directory / "statistics.json"));
    EXPECT_EQ(directory.entry_count(), 0u) << "checking leaves nothing behind";
}

/// Stands in for a full disk: no file may grow beyond `bytes`.
class FileSizeLimit {
public:
    explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
        ::getrlimit(RLIMIT_FSIZE, &before_);
        const rlimit limit{bytes, before_.rlim_max};
        ::setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~FileSizeLimit() {
        ::setrlimit(RLIMIT_FSIZE, &before_);
        std::signal(SIGXFSZ, handler_);
    }
    FileSizeLimit(const FileSizeLimit&) = delete;
    FileSizeLimit& operator=(const FileSizeLimit&) = delete;

private:
    rlimit before_{};
    void (*handler_)(int);
};

TEST(Writing, ThatFailsMidwayLeavesTheOldFileAndNothingElse) {
    const TemporaryDirectory directory;
    ASSERT_TRUE(write_file_atomically(directory / "a.pfm", "old"));
    Result<void> written;
    {
        const FileSizeLimit limit(4096);
        written = write_picture(directory / "a.pfm", Picture{tests::hdr_noise(64, 64, 3, 1), {}, 0, false});
    }
    ASSERT_FALSE(written);
    EXPECT_EQ(written.error().where, (directory / "a.pfm").string());
    EXPECT_EQ(read_file(directory / "a.pfm").value(), "old");
    EXPECT_EQ(directory.entry_count(), 1u);
}

}  // namespace
}  // namespace heliodon
