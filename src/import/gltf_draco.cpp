#include <draco/compression/decode.h>
#include <fmt/format.h>

#include <algorithm>

#include "import/gltf.h"

namespace heliodon::import::gltf {
namespace {

/// Largest value of an integer type; 0 for those that are read as floats.
float largest_value(draco::DataType type) {
    switch (type) {
        case draco::DT_INT8:
            return 127.0f;
        case draco::DT_UINT8:
            return 255.0f;
        case draco::DT_INT16:
            return 32767.0f;
        case draco::DT_UINT16:
            return 65535.0f;
        default:
            return 0.0f;
    }
}

void convert(const draco::PointAttribute& source, bool normalized, std::size_t points,
             DracoPrimitive::Attribute& target) {
    target.components = source.num_components();
    target.values.resize(points * std::size_t(target.components));
    const float largest = largest_value(source.data_type());
    for (std::size_t point = 0; point < points; ++point) {
        const auto value = source.mapped_index(draco::PointIndex(std::uint32_t(point)));
        float* out = &target.values[point * std::size_t(target.components)];
        if (largest == 0.0f) {
            source.ConvertValue<float>(value, std::int8_t(target.components), out);
            continue;
        }
        std::int32_t integers[4] = {};
        source.ConvertValue<std::int32_t>(value, std::int8_t(target.components), integers);
        for (int c = 0; c < target.components; ++c)
            out[c] = normalized ? std::max(float(integers[c]) / largest, -1.0f) : float(integers[c]);
    }
}

}  // namespace

DracoPrimitive decode_draco(const Document& document, const Json& primitive, const std::string& json_path) {
    const std::string at = json_path + ".extensions.KHR_draco_mesh_compression";
    const Json& json = *extension(primitive, "KHR_draco_mesh_compression");
    const BufferView& view = document.view(*index_member(document, json, "bufferView", "bufferViews", at));
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(view.bytes.data()), view.bytes.size());
    draco::Decoder decoder;
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok())
        document.refuse(at, fmt::format("draco cannot decode it: {}", decoded.status().error_msg_string()));
    const std::unique_ptr<draco::Mesh> mesh = std::move(decoded).value();

    DracoPrimitive result;
    result.vertex_count = mesh->num_points();
    result.indices.reserve(std::size_t(mesh->num_faces()) * 3);
    for (draco::FaceIndex face(0); face < mesh->num_faces(); ++face)
        for (int k = 0; k < 3; ++k) result.indices.push_back(mesh->face(face)[std::size_t(k)].value());
    for (const auto& [name, id] : json["attributes"].items()) {
        const draco::PointAttribute* source = mesh->GetAttributeByUniqueId(id.get<std::uint32_t>());
        if (!source) document.refuse(at + ".attributes." + name, fmt::format("draco holds no attribute {}", id.dump()));
        if (source->num_components() < 1 || source->num_components() > 4)
            document.refuse(at + ".attributes." + name, "expected 1 to 4 components");
        // What the extension does not say, whether integers are normalized, the primitive's accessor does.
        const auto accessor =
            index_member(document, primitive["attributes"], name.c_str(), "accessors", json_path + ".attributes");
        if (!accessor) document.refuse(at + ".attributes." + name, "expected the same attribute on the primitive");
        DracoPrimitive::Attribute attribute{.name = name};
        convert(*source, document.accessor(*accessor).normalized, result.vertex_count, attribute);
        result.attributes.push_back(std::move(attribute));
    }
    return result;
}

}  // namespace heliodon::import::gltf
