#include <imgui.h>

#include "host/preview/window/panels.h"

namespace etendue {
namespace {

template <class Choice, class Name>
void combo(const char* label, Choice& value, int count, Name name) {
    if (!ImGui::BeginCombo(label, name(value))) return;
    for (int i = 0; i < count; ++i)
        if (ImGui::Selectable(name(Choice(i)), int(value) == i)) value = Choice(i);
    ImGui::EndCombo();
}

}  // namespace

void draw_film_panel(ViewState& state) {
    if (!ImGui::CollapsingHeader("Film", ImGuiTreeNodeFlags_DefaultOpen)) return;
    combo("layer", state.request.layer, layer_count, layer_name);
    combo("tone curve", state.view.curve, 5, tone_curve_name);
    float exposure = float(state.view.exposure);
    if (ImGui::SliderFloat("exposure", &exposure, -16, 16, "%+.2f")) state.view.exposure = exposure;
    bool balance = state.view.temperature.has_value();
    if (ImGui::Checkbox("white balance", &balance))
        state.view.temperature = balance ? std::optional<double>(6504) : std::nullopt;
    if (state.view.temperature) {
        float kelvin = float(*state.view.temperature);
        if (ImGui::SliderFloat("white, K", &kelvin, warmest_white, coolest_white, "%.0f",
                               ImGuiSliderFlags_Logarithmic))
            state.view.temperature = kelvin;
    }
    if (state.view.curve == ToneCurve::false_colors) {
        float ends[2] = {float(state.view.lowest), float(state.view.highest)};
        const PreviewReceiver* receiver = shown_receiver(state);
        ImGui::Checkbox("scale fits the picture", &state.fits_scale);
        if (ImGui::DragFloatRange2(state.shows_meter ? receiver->unit.c_str() : "cd/m²", &ends[0], &ends[1],
                                   0.01f, 1e-6f, 1e9f, "%.3g", "%.3g", ImGuiSliderFlags_Logarithmic))
            state.view.lowest = ends[0], state.view.highest = ends[1], state.fits_scale = false;
        if (state.shows_meter) ImGui::Checkbox("isolines", &state.isolines);
    }
    combo("algorithm", state.request.algorithm, 4, algorithm_name);
    int seed = int(state.request.seed);
    if (ImGui::InputInt("seed", &seed) && seed >= 0) state.request.seed = uint32_t(seed);
    if (ImGui::Button(state.request.paused ? "Go on" : "Pause")) state.request.paused = !state.request.paused;
    ImGui::SameLine();
    if (ImGui::Button("Save EXR and PNG")) save_image(state);
}

}  // namespace etendue
