#include <imgui.h>

#include "host/preview/window/panels.h"

namespace etendue {
namespace {

void choose_variant(ViewState& state) {
    const std::string& now = state.import.variant;
    if (!ImGui::BeginCombo("variant", now.empty() ? "none" : now.c_str())) return;
    const auto offer = [&](const std::string& name, const char* label) {
        if (ImGui::Selectable(label, name == now) && name != now) {
            state.import.variant = name;
            reload_scene(state);
        }
    };
    offer("", "none");
    for (const std::string& name : state.status.variants) offer(name, name.c_str());
    ImGui::EndCombo();
}

void choose_moment(ViewState& state) {
    bool posed = state.import.seconds.has_value();
    if (ImGui::Checkbox("animated", &posed)) {
        state.import.seconds = posed ? std::optional<double>(0) : std::nullopt;
        reload_scene(state);
    }
    if (!posed) return;
    float seconds = float(*state.import.seconds);
    if (ImGui::SliderFloat("at", &seconds, 0, float(state.status.animation_seconds), "%.3f s")) {
        state.import.seconds = double(seconds);
        reload_scene(state);
    }
}

}  // namespace

void draw_scene_panel(ViewState& state) {
    const bool has_variants = !state.status.variants.empty(), moves = state.status.animation_seconds > 0;
    if (!(has_variants || moves) || !ImGui::CollapsingHeader("Scene", ImGuiTreeNodeFlags_DefaultOpen)) return;
    if (has_variants) choose_variant(state);
    if (moves) choose_moment(state);
}

}  // namespace etendue
