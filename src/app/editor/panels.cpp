#include "app/editor/panels.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>
#include <initializer_list>
#include <utility>
#include <vector>

#include "app/editor/choice.h"
#include "app/editor/display_panel.h"
#include "scene/render_limits.h"

namespace heliodon::editor {
namespace {

void timing_panel(const FrameReport& report) {
    ImGui::Text("%s", report.device.c_str());
    ImGui::Text("%.3f ms GPU a frame, %d frames accumulated", report.gpu_ms_total, report.accumulated_frames);
    for (const Error& error : report.shader_errors) ImGui::TextColored({1.0f, 0.4f, 0.3f, 1.0f}, "%s", error.text().c_str());
    if (!ImGui::BeginTable("passes", 2, ImGuiTableFlags_SizingFixedFit)) return;
    for (const PassTime& pass : report.passes) {
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(pass.name.c_str());
        ImGui::TableNextColumn();
        ImGui::Text("%8.3f ms", pass.gpu_ms);
    }
    ImGui::EndTable();
}

bool degrees_slider(const char* label, float& radians, float low_deg, float high_deg) {
    float degrees = glm::degrees(radians);
    if (!ImGui::SliderFloat(label, &degrees, low_deg, high_deg, "%.1f deg")) return false;
    radians = glm::radians(degrees);
    return true;
}

void exposure_controls(Camera& camera) {
    bool by_value = camera.ev100_override.has_value();
    if (ImGui::Checkbox("exposure by value", &by_value)) {
        const float current = camera.ev100();
        camera.ev100_override = by_value ? std::optional(current) : std::nullopt;
    }
    if (camera.ev100_override) {
        ImGui::SliderFloat("EV100", &*camera.ev100_override, -6.0f, 20.0f, "%.2f");
        return;
    }
    constexpr auto logarithmic = ImGuiSliderFlags_Logarithmic;
    ImGui::SliderFloat("aperture", &camera.aperture_f, 1.0f, 32.0f, "f/%.1f", logarithmic);
    ImGui::SliderFloat("shutter", &camera.shutter_s, 1.0f / 8000.0f, 10.0f, "%.5f s", logarithmic);
    ImGui::SliderFloat("ISO", &camera.iso, 25.0f, 25600.0f, "%.0f", logarithmic);
    ImGui::Text("EV100 %.2f", camera.ev100());
}

void camera_panel(const Scene& scene, ViewState& view) {
    scene.cameras().each([&](CameraId id, const Camera& camera) {
        ImGui::PushID(static_cast<int>(id.index));  // names need not differ
        if (ImGui::Button(camera.name.empty() ? "camera" : camera.name.c_str())) view.camera = camera;
        ImGui::PopID();
        ImGui::SameLine();
    });
    ImGui::NewLine();
    if (ImGui::RadioButton("orbit", !view.fly)) view.fly = false;
    ImGui::SameLine();
    if (ImGui::RadioButton("fly", view.fly)) view.fly = true;
    ImGui::SameLine();
    ImGui::SetNextItemWidth(120.0f);
    ImGui::SliderFloat("speed", &view.fly_speed_m_per_s, 0.1f, 100.0f, "%.1f m/s", ImGuiSliderFlags_Logarithmic);
    Camera moved = view.camera;
    ImGui::DragFloat3("position", glm::value_ptr(moved.position), 0.01f, 0, 0, "%.2f m");
    ImGui::DragFloat3("target", glm::value_ptr(moved.target), 0.01f, 0, 0, "%.2f m");
    // A camera at its target, or one that looks along its up vector, has no picture.
    if (glm::length(glm::cross(moved.target - moved.position, moved.up)) > 1e-4f) view.camera = moved;
    degrees_slider("field of view", view.camera.vertical_fov_rad, 5.0f, 120.0f);
    exposure_controls(view.camera);
}

bool edit_light(Light& light) {
    const bool directional = light.type == LightType::directional;
    const float largest = std::max({light.intensity.r, light.intensity.g, light.intensity.b, 1.0f});
    bool edited = ImGui::DragFloat3(directional ? "illuminance (lx)" : "intensity (cd)", glm::value_ptr(light.intensity),
                                    0.01f * largest, 0.0f, 1e7f, "%.1f");
    if (directional) {
        edited |= ImGui::DragFloat3("direction", glm::value_ptr(light.direction), 0.01f, -1.0f, 1.0f);
        edited |= degrees_slider("angular diameter", light.angular_diameter_rad, 0.0f, 20.0f);
        return edited;
    }
    if (!light.luminaire) edited |= ImGui::DragFloat("radius", &light.radius_m, 0.001f, 0.0f, 10.0f, "%.3f m");
    if (light.type == LightType::spot) {
        edited |= degrees_slider("inner", light.inner_rad, 0.0f, 89.0f);
        edited |= degrees_slider("outer", light.outer_rad, 0.5f, 90.0f);
        light.inner_rad = std::min(light.inner_rad, light.outer_rad);
    }
    ImGui::Text("%.1f lm", flux_lm(light));
    return edited;
}

void lights_panel(Scene& scene) {
    std::vector<NodeId> lamps;
    scene.nodes().each([&](NodeId id, const Node& node) {
        if (node.light) lamps.push_back(id);
    });
    for (const NodeId id : lamps) {
        const Node& node = *scene.nodes().find(id);
        ImGui::PushID(static_cast<int>(id.index));
        if (ImGui::TreeNodeEx(node.name.empty() ? "light" : node.name.c_str(), ImGuiTreeNodeFlags_DefaultOpen)) {
            Light light = *node.light;
            Transform transform = node.transform;
            if (light.type != LightType::directional &&
                ImGui::DragFloat3("place", glm::value_ptr(transform.translation), 0.01f, 0, 0, "%.2f m"))
                scene.set_transform(id, transform);
            const bool usable = glm::length(light.direction) > 0.0f;
            if (edit_light(light) && usable) scene.set_light(id, light);
            ImGui::TreePop();
        }
        ImGui::PopID();
    }
}

bool edit_material(Material& material) {
    bool edited = ImGui::ColorEdit3("base colour", glm::value_ptr(material.base_color), ImGuiColorEditFlags_Float);
    if (material.model == MaterialModel::standard) {
        edited |= ImGui::SliderFloat("metallic", &material.metallic, 0.0f, 1.0f);
        edited |= ImGui::SliderFloat("roughness", &material.roughness, 0.0f, 1.0f);
        edited |= ImGui::SliderFloat("index of refraction", &material.ior, 1.0f, 3.0f);
        edited |= ImGui::SliderFloat("transmission", &material.transmission, 0.0f, 1.0f);
    }
    edited |= ImGui::DragFloat3("emission", glm::value_ptr(material.emission_nits), 1.0f, 0.0f, 1e7f, "%.1f cd/m2");
    if (material.alpha_mode == AlphaMode::blend) edited |= ImGui::SliderFloat("opacity", &material.opacity, 0.0f, 1.0f);
    edited |= ImGui::Checkbox("two-sided", &material.two_sided);
    return edited;
}

void materials_panel(Scene& scene) {
    for (std::uint32_t slot = 0; slot < scene.materials().capacity(); ++slot) {
        const Material* found = scene.materials().at(slot);
        if (!found) continue;
        ImGui::PushID(static_cast<int>(slot));
        if (ImGui::TreeNode(found->name.empty() ? "material" : found->name.c_str())) {
            Material material = *found;
            if (edit_material(material)) scene.set_material(scene.materials().id_at(slot), std::move(material));
            ImGui::TreePop();
        }
        ImGui::PopID();
    }
}

/// One of a few numbers; a value that is not among them is shown all the same.
bool number_choice(const char* label, int& value, std::initializer_list<int> choices) {
    if (!ImGui::BeginCombo(label, std::to_string(value).c_str())) return false;
    const int before = value;
    for (const int choice : choices)
        if (ImGui::Selectable(std::to_string(choice).c_str(), choice == value)) value = choice;
    ImGui::EndCombo();
    return value != before;
}

bool edit_volume(RenderSettings& settings) {
    bool edited = number_choice("voxels an edge", settings.voxels, {32, 64, 128, 256, 512});
    edited |= ImGui::SliderInt("cascades", &settings.cascades, 1, most_voxel_cascades, "%d",
                               ImGuiSliderFlags_AlwaysClamp);
    edited |= ImGui::SliderInt("bounces", &settings.bounces, 0, most_counted_bounces,
                               settings.bounces == 0 ? "all" : "%d",
                               ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_Logarithmic);
    edited |= named_choice("revoxelize", settings.revoxelize, "once\0where changed\0every frame\0");
    edited |= named_choice("voxelizer", settings.voxelizer, "the faster\0rasterizer\0compute\0");
    return edited;
}

bool edit_cone_tracing(ConeTracingSettings& vct) {
    bool edited = ImGui::Checkbox("diffuse", &vct.diffuse);
    edited |= ImGui::Checkbox("specular", &vct.specular);
    edited |= ImGui::Checkbox("refraction", &vct.refraction);
    edited |= ImGui::Checkbox("shadows by cones", &vct.shadows);
    edited |= ImGui::Checkbox("occlusion of the sky", &vct.ao);
    edited |= ImGui::Checkbox("narrow cones in still pictures", &vct.narrow);
    edited |= ImGui::Checkbox("caustics", &vct.caustics);
    edited |= number_choice("diffuse cones", vct.cones, {9, 18, 36, 72, 144});
    edited |= named_choice("resolution", vct.resolution, "full\0half\0quarter\0");
    edited |= named_choice("voxels show", vct.filtering, "six sides\0one value\0");
    return edited;
}

/// A length in metres whose 0 means without bound.
bool length_slider(const char* label, float& length_m, const char* unbounded) {
    return ImGui::SliderFloat(label, &length_m, 0, 100, length_m > 0 ? "%.2f m" : unbounded,
                              ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_Logarithmic);
}

bool edit_ambient_occlusion(AmbientOcclusionSettings& occlusion) {
    bool edited = ImGui::Checkbox("the sky hidden by what is seen", &occlusion.on);
    edited |= length_slider("within", occlusion.reach_m, "the picture");
    edited |= length_slider("thickness", occlusion.thickness_m, "without end");
    return edited;
}

void global_illumination_panel(Scene& scene) {
    RenderSettings settings = scene.render_settings();
    bool traced = settings.gi == "vct";
    bool edited = ImGui::Checkbox("voxel cone tracing", &traced);
    if (edited) settings.gi = traced ? "vct" : "none";
    ImGui::BeginDisabled(!traced);
    edited |= edit_volume(settings);
    edited |= edit_cone_tracing(settings.vct);
    ImGui::EndDisabled();
    ImGui::BeginDisabled(traced);
    edited |= named_choice("ambient, approximate", settings.ambient, "none\0constant\0directional\0");
    edited |= edit_ambient_occlusion(settings.ambient_occlusion);
    ImGui::EndDisabled();
    if (edited) scene.set_render_settings(std::move(settings));
}

bool edit_shadow_cascades(ShadowCascadeSettings& cascades) {
    bool edited = ImGui::SliderInt("shadow cascades", &cascades.count, 1, most_shadow_cascades, "%d", ImGuiSliderFlags_AlwaysClamp);
    edited |= ImGui::SliderFloat("split, even to ratio", &cascades.split, 0, 1, "%.2f", ImGuiSliderFlags_AlwaysClamp);
    edited |= ImGui::SliderFloat("blend", &cascades.blend, 0, 0.5f, "%.3f", ImGuiSliderFlags_AlwaysClamp);
    edited |= length_slider("as far as", cascades.distance_m, "the scene");
    return edited;
}

bool edit_shadow_volumes(ShadowVolumeSettings& volumes) {
    bool edited = number_choice("map of lit triangles", volumes.map_size, {256, 512, 1024, 2048, 4096});
    edited |= ImGui::SliderFloat("significant area", &volumes.significant_px, 0.001f, 100, "%.3f texels",
                                 ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_Logarithmic);
    return edited;
}

void sun_shadows_panel(Scene& scene) {
    RenderSettings settings = scene.render_settings();
    bool edited = named_choice("shadows of the sun", settings.sun_shadows, "cascades of maps\0volumes\0");
    edited |= edit_shadow_cascades(settings.shadow_cascades);
    ImGui::BeginDisabled(settings.sun_shadows != SunShadows::volumes);
    edited |= edit_shadow_volumes(settings.shadow_volumes);
    ImGui::EndDisabled();
    if (edited) scene.set_render_settings(std::move(settings));
}

}  // namespace

void draw_panels(Scene& scene, ViewState& view, const FrameReport& report) {
    if (!view.panels_visible) return;
    ImGui::SetNextWindowPos({12, 12}, ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowSize({360, 560}, ImGuiCond_FirstUseEver);
    if (ImGui::Begin("Scene")) {
        ImGui::PushItemWidth(190.0f);
        if (ImGui::CollapsingHeader("Camera", ImGuiTreeNodeFlags_DefaultOpen)) camera_panel(scene, view);
        if (ImGui::CollapsingHeader("Lights", ImGuiTreeNodeFlags_DefaultOpen)) lights_panel(scene);
        if (ImGui::CollapsingHeader("Materials", ImGuiTreeNodeFlags_DefaultOpen)) materials_panel(scene);
        if (ImGui::CollapsingHeader("Global illumination", ImGuiTreeNodeFlags_DefaultOpen))
            global_illumination_panel(scene);
        if (ImGui::CollapsingHeader("Shadows of the sun")) sun_shadows_panel(scene);
        if (ImGui::CollapsingHeader("Exposure and tone")) display_panel(scene);
        ImGui::PopItemWidth();
    }
    ImGui::End();
    const float right = ImGui::GetIO().DisplaySize.x - 12.0f;
    ImGui::SetNextWindowPos({right, 12}, ImGuiCond_Always, {1.0f, 0.0f});
    if (ImGui::Begin("GPU time", nullptr, ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoFocusOnAppearing))
        timing_panel(report);
    ImGui::End();
}

}  // namespace heliodon::editor
