#include "gpu/pipeline_cache.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <span>
#include <vector>

#include "gpu/device.h"

namespace heliodon::gpu {
namespace {

/// Before the driver's bytes: drivers trust their own header and may crash on damaged data behind it.
struct FileHeader {
    char magic[8] = {'H', 'E', 'L', 'I', 'O', 'P', 'C', '1'};
    std::uint64_t bytes = 0;
    std::uint64_t hash = 0;
};

/// FNV-1a, 64 bits (Fowler, Noll, Vo 1991).
std::uint64_t hash_of(std::span<const char> bytes) {
    std::uint64_t hash = 14695981039346656037ull;
    for (const char byte : bytes) hash = (hash ^ static_cast<unsigned char>(byte)) * 1099511628211ull;
    return hash;
}

std::string file_name(const VkPhysicalDeviceProperties& properties) {
    std::string name;
    for (const std::uint8_t byte : properties.pipelineCacheUUID) name += fmt::format("{:02x}", byte);
    return name +
           fmt::format("-{:x}-{:x}-{:x}.bin", properties.vendorID, properties.deviceID, properties.driverVersion);
}

std::vector<char> load(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    FileHeader header;
    const FileHeader expected;
    if (!stream.read(reinterpret_cast<char*>(&header), sizeof(header))) return {};
    std::error_code error;
    const auto size = std::filesystem::file_size(file, error);
    if (error || std::memcmp(header.magic, expected.magic, sizeof(header.magic)) != 0 ||
        header.bytes != size - sizeof(header))
        return {};
    std::vector<char> bytes(header.bytes);
    if (!stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size())) || hash_of(bytes) != header.hash)
        return {};
    return bytes;
}

}  // namespace

std::filesystem::path default_cache_directory() {
    if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache && *cache)
        return std::filesystem::path(cache) / "heliodon";
    if (const char* home = std::getenv("HOME"); home && *home)
        return std::filesystem::path(home) / ".cache" / "heliodon";
    return {};
}

PipelineCache::PipelineCache(const Device& device, const std::filesystem::path& directory) : device_(device) {
    std::vector<char> bytes;
    if (!directory.empty()) {
        file_ = directory / file_name(device.properties());
        bytes = load(file_);
    }
    VkPipelineCacheCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
    info.initialDataSize = bytes.size();
    info.pInitialData = bytes.data();
    if (vkCreatePipelineCache(device.handle(), &info, nullptr, &handle_) == VK_SUCCESS) {
        loaded_bytes_ = bytes.size();
        return;
    }
    info.initialDataSize = 0;
    if (vkCreatePipelineCache(device.handle(), &info, nullptr, &handle_) != VK_SUCCESS) handle_ = VK_NULL_HANDLE;
}

PipelineCache::~PipelineCache() {
    save();
    if (handle_) vkDestroyPipelineCache(device_.handle(), handle_, nullptr);
}

void PipelineCache::save() const noexcept try {
    std::size_t size = 0;
    if (!handle_ || file_.empty() || vkGetPipelineCacheData(device_.handle(), handle_, &size, nullptr) != VK_SUCCESS)
        return;
    if (size == loaded_bytes_) return;  // nothing new
    std::vector<char> bytes(size);
    if (vkGetPipelineCacheData(device_.handle(), handle_, &size, bytes.data()) != VK_SUCCESS) return;
    bytes.resize(size);
    FileHeader header;
    header.bytes = bytes.size();
    header.hash = hash_of(bytes);

    std::error_code error;
    std::filesystem::create_directories(file_.parent_path(), error);
    const std::filesystem::path temporary = file_.string() + fmt::format(".{}.tmp", getpid());
    bool written = false;
    {
        std::ofstream stream(temporary, std::ios::binary);
        stream.write(reinterpret_cast<const char*>(&header), sizeof(header));
        stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        stream.flush();
        written = stream.good();
    }
    if (written) std::filesystem::rename(temporary, file_, error);
    if (!written || error) std::filesystem::remove(temporary, error);
} catch (...) {
    // A cache that cannot be written costs time, not correctness.
}

}  // namespace heliodon::gpu
