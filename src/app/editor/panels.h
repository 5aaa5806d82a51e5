#pragma once

#include <span>
#include <string>

#include "realtime/renderer.h"
#include "scene/scene.h"

namespace heliodon::editor {

/// What the panels show that is not in the scene.
struct FrameReport {
    std::span<const PassTime> passes;
    double gpu_ms_total = 0;
    std::string device;
    int accumulated_frames = 0;
    std::span<const Error> shader_errors;  ///< of the latest reload
};

/// The panels' own state: the camera the window looks through and how it moves.
struct ViewState {
    Camera camera;
    bool fly = false;  ///< false: orbit
    float fly_speed_m_per_s = 1.0f;
    bool panels_visible = true;
};

/// Draws the overlay with Dear ImGui into the current frame: milliseconds a pass, camera and exposure,
/// lights, materials and global illumination. Every edit of the scene goes through its change journal.
void draw_panels(Scene& scene, ViewState& view, const FrameReport& report);

}  // namespace heliodon::editor
