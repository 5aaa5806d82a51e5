#pragma once

#include <string>

#include "core/result.h"
#include "scene/scene.h"

namespace heliodon::editor {

struct ViewerSettings {
    std::string device;            ///< as RealtimeSettings'
    std::string camera;            ///< name; empty: the scene's first
    std::string shader_directory;  ///< for F5, reload
    bool validation = false;
    int width = 1280, height = 720;
};

/// Opens a window on `scene` and returns when it is closed. Lights, materials and the camera are editable
/// live, through the scene's change journal.
[[nodiscard]] Result<void> view(Scene scene, const ViewerSettings& settings);

}  // namespace heliodon::editor
