#include <fmt/format.h>
#include <imgui.h>

#include "host/preview/window/panels.h"

namespace etendue {

void draw_camera_panel(ViewState& state) {
    const PreviewReceiver* shown = shown_receiver(state);
    if (!shown || !ImGui::CollapsingHeader("Camera", ImGuiTreeNodeFlags_DefaultOpen)) return;
    if (ImGui::BeginCombo("receiver", shown->name.c_str())) {
        for (uint32_t i = 0; i < state.status.receivers.size(); ++i) {
            const PreviewReceiver& r = state.status.receivers[i];
            const std::string label = fmt::format("{} ({})##{}", r.name, r.class_name, i);
            if (ImGui::Selectable(label.c_str(), i == state.request.receiver)) choose_receiver(state, i);
        }
        ImGui::EndCombo();
    }
    const glm::dvec3 at = glm::dvec3(state.pose.placement[3]);
    ImGui::Text("at %.4g %.4g %.4g m", at.x, at.y, at.z);
    ImGui::Text("pivot at %.4g m", pivot_distance(state.pose));
    if (ImGui::Button("Reset")) reset_camera(state);
    ImGui::SameLine();
    if (ImGui::Button("Copy as glTF")) copy_camera(state);
}

}  // namespace etendue
