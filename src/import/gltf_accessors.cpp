#include <fmt/format.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "import/gltf_document.h"

namespace heliodon::import::gltf {
namespace {

template <class T>
T load(const std::uint8_t* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof value);
    return value;
}

std::uint32_t load_index(const std::uint8_t* bytes, ComponentType type) {
    switch (type) {
        case ComponentType::u8:
            return *bytes;
        case ComponentType::u16:
            return load<std::uint16_t>(bytes);
        default:
            return load<std::uint32_t>(bytes);
    }
}

/// Integers to floats by glTF 2.0, section 3.11: c / max, and max(c / max, −1) for signed ones.
template <class T>
float to_float(const std::uint8_t* bytes, bool normalized) {
    const T value = load<T>(bytes);
    if constexpr (std::is_floating_point_v<T>) return value;
    if (!normalized) return float(value);
    return std::max(float(double(value) / double(std::numeric_limits<T>::max())), -1.0f);
}

float component_to_float(const std::uint8_t* bytes, ComponentType type, bool normalized) {
    switch (type) {
        case ComponentType::i8:
            return to_float<std::int8_t>(bytes, normalized);
        case ComponentType::u8:
            return to_float<std::uint8_t>(bytes, normalized);
        case ComponentType::i16:
            return to_float<std::int16_t>(bytes, normalized);
        case ComponentType::u16:
            return to_float<std::uint16_t>(bytes, normalized);
        case ComponentType::u32:
            return to_float<std::uint32_t>(bytes, normalized);
        default:
            return load<float>(bytes);
    }
}

}  // namespace

void Document::expect_affordable(std::size_t index, std::string_view json_path) const {
    constexpr std::size_t most_zeros = std::size_t(1) << 24;  // elements: 256 MiB of four floats each
    if (!accessors_[index].has_values && accessors_[index].count > most_zeros)
        refuse(json_path, fmt::format("expected a bufferView behind {} elements, found none", accessors_[index].count));
}

void Document::read_floats(std::size_t index, int components, float* out, std::string_view json_path) const {
    const Accessor& accessor = accessors_[index];
    const int shared = std::min(components, accessor.components);
    const std::size_t size = size_of(accessor.type);
    const auto write = [&](std::size_t element, const std::uint8_t* bytes) {
        float* target = out + element * std::size_t(components);
        for (int c = 0; c < shared; ++c) {
            target[c] = component_to_float(bytes + std::size_t(c) * size, accessor.type, accessor.normalized);
            if (!std::isfinite(target[c]))
                refuse(json_path, fmt::format("expected finite numbers, found {} in element {}", target[c], element));
        }
        for (int c = shared; c < components; ++c) target[c] = c == 3 ? 1.0f : 0.0f;
    };
    if (accessor.has_values)
        for (std::size_t i = 0; i < accessor.count; ++i) write(i, accessor.bytes.data() + i * accessor.stride);
    else
        std::fill(out, out + accessor.count * std::size_t(components), 0.0f);
    if (!accessor.sparse) return;
    const Accessor::Sparse& sparse = *accessor.sparse;
    const std::size_t element_size = size * std::size_t(accessor.components);
    for (std::size_t i = 0; i < sparse.count; ++i) {
        const std::uint32_t element =
            load_index(sparse.indices.data() + i * size_of(sparse.index_type), sparse.index_type);
        if (element >= accessor.count)
            refuse(json_path, fmt::format("sparse index {} is past the last element {}", element, accessor.count - 1));
        write(element, sparse.values.data() + i * element_size);
    }
}

PaddedArray<std::uint32_t> Document::read_indices(std::size_t index) const {
    const Accessor& accessor = accessors_[index];
    expect_affordable(index, fmt::format("$.accessors[{}]", index));
    PaddedArray<std::uint32_t> indices(accessor.count, 0);
    if (accessor.has_values)
        for (std::size_t i = 0; i < accessor.count; ++i)
            indices[i] = load_index(accessor.bytes.data() + i * accessor.stride, accessor.type);
    if (accessor.sparse) {
        const Accessor::Sparse& sparse = *accessor.sparse;
        for (std::size_t i = 0; i < sparse.count; ++i) {
            const std::uint32_t element =
                load_index(sparse.indices.data() + i * size_of(sparse.index_type), sparse.index_type);
            if (element >= accessor.count)
                refuse(fmt::format("$.accessors[{}].sparse", index), fmt::format("index {} is past the end", element));
            indices[element] = load_index(sparse.values.data() + i * size_of(accessor.type), accessor.type);
        }
    }
    return indices;
}

std::vector<std::uint8_t> decode_meshopt(const Document& document, const Json& extension, Bytes source,
                                         std::string_view json_path) {
    const std::size_t count = unsigned_member(document, extension, "count", {}, json_path);
    const std::size_t stride = unsigned_member(document, extension, "byteStride", {}, json_path);
    const std::string mode = extension.value("mode", ""), filter = extension.value("filter", "NONE");
    const bool attributes = mode == "ATTRIBUTES";
    if (!attributes && mode != "TRIANGLES" && mode != "INDICES")
        document.refuse(json_path, "expected mode ATTRIBUTES, TRIANGLES or INDICES, found \"" + mode + "\"");
    if (attributes ? stride == 0 || stride > 256 || stride % 4 != 0 : stride != 2 && stride != 4)
        document.refuse(json_path, fmt::format("byteStride {} does not go with mode {}", stride, mode));
    if (mode == "TRIANGLES" && count % 3 != 0)
        document.refuse(json_path, fmt::format("expected whole triangles, found {} indices", count));
    // 16 bytes of vertices take at least a header of two bits, and triangles and indices more, so that valid
    // data never expands more than this; it refuses a count that only wants memory.
    constexpr std::size_t most_expansion = 64;
    if (count / most_expansion > source.size() / stride)
        document.refuse(json_path, fmt::format("{} elements cannot come from {} bytes", count, source.size()));
    std::vector<std::uint8_t> bytes(count * stride);
    const int failed =
        attributes            ? meshopt_decodeVertexBuffer(bytes.data(), count, stride, source.data(), source.size())
        : mode == "TRIANGLES" ? meshopt_decodeIndexBuffer(bytes.data(), count, stride, source.data(), source.size())
                              : meshopt_decodeIndexSequence(bytes.data(), count, stride, source.data(), source.size());
    if (failed) document.refuse(json_path, fmt::format("meshoptimizer cannot decode its {} bytes", source.size()));
    if (filter == "NONE") return bytes;
    const bool octahedral = filter == "OCTAHEDRAL" && (stride == 4 || stride == 8);
    const bool quaternion = filter == "QUATERNION" && stride == 8;
    const bool exponential = filter == "EXPONENTIAL" && stride % 4 == 0;
    if (!attributes || (!octahedral && !quaternion && !exponential))
        document.refuse(json_path,
                        fmt::format("filter {} does not go with mode {} and byteStride {}", filter, mode, stride));
    if (octahedral) meshopt_decodeFilterOct(bytes.data(), count, stride);
    if (quaternion) meshopt_decodeFilterQuat(bytes.data(), count, stride);
    if (exponential) meshopt_decodeFilterExp(bytes.data(), count, stride);
    return bytes;
}

}  // namespace heliodon::import::gltf
