#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <random>
#include <utility>

#include "core/image_io.h"

namespace heliodon {
namespace {

/// An open file descriptor that closes itself.
class File {
public:
    File(const char* path, int flags, mode_t mode = 0) : descriptor_(::open(path, flags | O_CLOEXEC, mode)) {}
    ~File() {
        if (descriptor_ >= 0) ::close(descriptor_);
    }
    File(const File&) = delete;
    File& operator=(const File&) = delete;
    [[nodiscard]] bool is_open() const { return descriptor_ >= 0; }
    [[nodiscard]] int descriptor() const { return descriptor_; }
    /// False when the last bytes did not reach the file (network file systems report it only here).
    [[nodiscard]] bool close() {
        const int descriptor = std::exchange(descriptor_, -1);
        return ::close(descriptor) == 0;
    }

private:
    int descriptor_;
};

/// A file under a temporary name that disappears unless it is kept.
class TemporaryName {
public:
    explicit TemporaryName(std::filesystem::path path) : path_(std::move(path)) {}
    ~TemporaryName() {
        if (!path_.empty()) ::unlink(path_.c_str());
    }
    TemporaryName(const TemporaryName&) = delete;
    TemporaryName& operator=(const TemporaryName&) = delete;
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    void keep() { path_.clear(); }

private:
    std::filesystem::path path_;
};

std::string system_message() {
    return std::strerror(errno);
}

std::filesystem::path directory_of(const std::filesystem::path& path) {
    return path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
}

/// Devices and pipes take bytes as they come; a new file in their place would be no device. So does what
/// /dev/stdout names, even where the shell has made that a file.
bool is_special(const std::filesystem::path& path) {
    std::error_code ignored;
    const std::filesystem::file_status status = std::filesystem::status(path, ignored);
    if (!std::filesystem::exists(status) || std::filesystem::is_directory(status)) return false;
    const bool stream = path.parent_path() == "/dev" && std::filesystem::is_symlink(path, ignored);
    return stream || !std::filesystem::is_regular_file(status);
}

/// The file that `path` means: behind a link, so that the link stays.
std::filesystem::path behind_links(const std::filesystem::path& path) {
    std::error_code error;
    std::filesystem::path target = std::filesystem::is_symlink(path, error) ? std::filesystem::canonical(path, error) : path;
    return target.empty() ? path : target;
}

bool write_all(int descriptor, std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) return false;
        bytes.remove_prefix(static_cast<std::size_t>(written));
    }
    return true;
}

Result<void> write_special(const std::filesystem::path& path, std::string_view bytes) {
    File file(path.c_str(), O_WRONLY | O_APPEND);
    if (!file.is_open() || !write_all(file.descriptor(), bytes) || !file.close())
        return fail(path.string(), "cannot write: " + system_message());
    return {};
}

}  // namespace

Result<std::string> read_file(const std::filesystem::path& path) {
    const File file(path.c_str(), O_RDONLY);
    if (!file.is_open()) return fail(path.string(), "cannot open the file: " + system_message());
    struct stat status {};
    if (::fstat(file.descriptor(), &status) != 0) return fail(path.string(), "cannot read: " + system_message());
    if (S_ISDIR(status.st_mode)) return fail(path.string(), "expected a file, found a directory");
    try {
        std::string bytes(S_ISREG(status.st_mode) ? static_cast<std::size_t>(status.st_size) : 0, '\0');
        std::size_t filled = 0;
        for (;;) {
            // One byte more than expected, so that the end is seen and files that grow are read whole.
            if (filled == bytes.size()) bytes.resize(filled + (filled == 0 ? 65536 : filled / 8 + 1));
            const ssize_t count = ::read(file.descriptor(), bytes.data() + filled, bytes.size() - filled);
            if (count < 0 && errno == EINTR) continue;
            if (count < 0) return fail(path.string(), "cannot read: " + system_message());
            if (count == 0) break;
            filled += static_cast<std::size_t>(count);
        }
        bytes.resize(filled);
        return bytes;
    } catch (const std::bad_alloc&) {
        return fail(path.string(), "not enough memory to read the file");
    }
}

Result<void> write_file_atomically(const std::filesystem::path& path, std::string_view bytes) {
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored))
        return fail(path.string(), "expected a file name, found a directory");
    if (is_special(path)) return write_special(path, bytes);
    const std::filesystem::path target = behind_links(path);
    std::random_device random;
    // A short name of its own: appending to the target's could exceed what the file system allows.
    TemporaryName temporary(directory_of(target) / fmt::format(".heliodon-{:08x}{:08x}.tmp", random(), random()));
    File file(temporary.path().c_str(), O_WRONLY | O_CREAT | O_EXCL, 0666);
    if (!file.is_open()) {
        temporary.keep();  // not ours
        return fail(path.string(), "cannot write: " + system_message());
    }
    if (!write_all(file.descriptor(), bytes)) return fail(path.string(), "cannot write: " + system_message());
    if (!file.close()) return fail(path.string(), "cannot write: " + system_message());
    if (::rename(temporary.path().c_str(), target.c_str()) != 0) {
        return fail(path.string(), "cannot write: " + system_message());
    }
    temporary.keep();
    return {};
}

Result<void> check_directory_writable(const std::filesystem::path& path) {
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored))
        return fail(path.string(), "expected a file name, found a directory");
    if (is_special(path)) {
        if (::access(path.c_str(), W_OK) == 0) return {};
        return fail(path.string(), "cannot write: " + system_message());
    }
    const std::filesystem::path directory = directory_of(behind_links(path));
    if (!std::filesystem::exists(directory, ignored)) {
        return fail(path.string(), fmt::format("cannot write: the directory {} does not exist", directory.string()));
    }
    if (!std::filesystem::is_directory(directory, ignored)) {
        return fail(path.string(), fmt::format("cannot write: {} is not a directory", directory.string()));
    }
    if (::access(directory.c_str(), W_OK | X_OK) != 0) {
        return fail(path.string(),
                    fmt::format("cannot write to the directory {}: {}", directory.string(), system_message()));
    }
    return {};
}

}  // namespace heliodon
