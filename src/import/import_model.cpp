#include "import/import_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "import/import.h"
#include "import/import_failure.h"

namespace heliodon {

Result<NodeId> import_model(Scene& scene, NodeId parent, const std::filesystem::path& path, Warnings& warnings) {
    return import::guarded(path, [&] {
        std::string ending = path.extension().string();
        std::transform(ending.begin(), ending.end(), ending.begin(),
                       [](unsigned char c) { return char(std::tolower(c)); });
        if (ending == ".obj") return import::import_obj(scene, parent, path, warnings);
        if (ending == ".gltf" || ending == ".glb") return import::import_gltf(scene, parent, path, warnings);
        if (ending == ".ies" || ending == ".ldt") return import::import_luminaire(scene, parent, path, warnings);
        import::refuse(path.string(),
                       fmt::format("expected a model that ends in .obj, .gltf, .glb, .ies or .ldt, found \"{}\"", ending));
    });
}

}  // namespace heliodon
