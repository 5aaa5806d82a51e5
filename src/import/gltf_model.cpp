#include <fmt/format.h>

#include "import/gltf.h"

#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_INCLUDE_STB_IMAGE
#define TINYGLTF_NO_INCLUDE_STB_IMAGE_WRITE
#include <tiny_gltf.h>

namespace heliodon::import::gltf {

void read_model(const Document& document, tinygltf::Model& model) {
    Json description = Json::object();
    for (const char* member :
         {"asset", "scene", "scenes", "nodes", "materials", "textures", "samplers", "cameras", "animations"})
        if (const auto found = document.json().find(member); found != document.json().end())
            description[member] = *found;
    // tinygltf gives up on a list that is there but empty only for some sections; absent ones are fine.
    const std::string text = description.dump();
    tinygltf::TinyGLTF reader;
    std::string error, warning;
    if (!reader.LoadASCIIFromString(&model, &error, &warning, text.data(), unsigned(text.size()), "",
                                    tinygltf::REQUIRE_VERSION)) {
        while (!error.empty() && error.back() == '\n') error.pop_back();
        import::refuse(document.path().string(), "not a valid glTF: " + error);
    }
}

}  // namespace heliodon::import::gltf
