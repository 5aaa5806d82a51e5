#include "app/editor/display_panel.h"

#include <imgui.h>

#include "app/editor/choice.h"
#include "core/white_balance.h"

namespace heliodon::editor {
namespace {

bool edit_exposure(ExposureSettings& exposure) {
    bool edited = named_choice("exposed by", exposure.mode, "the camera\0a light meter\0the picture's key\0");
    edited |= ImGui::SliderFloat("compensation", &exposure.compensation_ev, -5.0f, 5.0f, "%+.2f EV");
    if (exposure.mode == ExposureMode::camera) return edited;
    edited |= named_choice("metering", exposure.pattern, "average\0centre-weighted\0spot\0");
    edited |= ImGui::Checkbox("arithmetic mean", &exposure.arithmetic_mean);
    glm::vec2 percent = exposure.percentiles * 100.0f;
    if (ImGui::DragFloatRange2("percentiles", &percent.x, &percent.y, 0.1f, 0.0f, 100.0f, "%.1f %%") && percent.x < percent.y)
        exposure.percentiles = percent / 100.0f, edited = true;
    edited |= ImGui::SliderFloat("to light", &exposure.to_light_s, 0.0f, 10.0f, "%.2f s");
    edited |= ImGui::SliderFloat("to dark", &exposure.to_dark_s, 0.0f, 60.0f, "%.2f s");
    return edited;
}

bool edit_tone(ToneSettings& tone) {
    bool edited = named_choice("tone curve", tone.curve, "linear\0Hable\0Reinhard\0ACES (Hill)\0ACES (Narkowicz)\0AgX\0Khronos PBR Neutral\0");
    if (tone.curve != ToneCurve::hable && tone.curve != ToneCurve::reinhard) {
        if (edited) tone.white = 0, tone.estimate_white = false;
        return edited;
    }
    edited |= ImGui::Checkbox("white from the picture", &tone.estimate_white);
    if (!tone.estimate_white)
        edited |= ImGui::SliderFloat("white", &tone.white, 0.0f, 50.0f, tone.white > 0 ? "%.2f" : "the curve's own");
    return edited;
}

bool edit_white_balance(DisplaySettings& display) {
    bool balanced = display.white_balance.has_value();
    bool edited = ImGui::Checkbox("white balance", &balanced);
    if (edited) display.white_balance = balanced ? std::optional(white_chromaticity(6504)) : std::nullopt;
    if (display.white_balance) edited |= ImGui::SliderFloat2("x, y", &display.white_balance->x, 0.2f, 0.55f, "%.4f");
    return edited;
}

}  // namespace

void display_panel(Scene& scene) {
    RenderSettings settings = scene.render_settings();
    bool edited = edit_exposure(settings.display.exposure);
    edited |= edit_tone(settings.display.tone);
    edited |= edit_white_balance(settings.display);
    if (edited) scene.set_render_settings(std::move(settings));
}

}  // namespace heliodon::editor
