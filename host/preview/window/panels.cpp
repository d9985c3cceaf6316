#include "host/preview/window/panels.h"

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>

#include "host/preview/window/shortcuts.h"

namespace etendue {
namespace {

constexpr double notice_seconds = 4;
constexpr float panel_width = 300, margin = 10;  // of a display of 96 dpi
constexpr auto fixed = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoSavedSettings |
                       ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoNav |
                       ImGuiWindowFlags_NoFocusOnAppearing;

void draw_line(const char* name, float y, const std::string& text, const ImVec4& color) {
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({size.x / 2, y}, ImGuiCond_Always, {0.5f, y < size.y / 2 ? 0.0f : 1.0f});
    ImGui::SetNextWindowBgAlpha(0.8f);
    ImGui::Begin(name, nullptr, fixed | ImGuiWindowFlags_NoInputs);
    ImGui::PushTextWrapPos(0.8f * size.x);
    ImGui::TextColored(color, "%s", text.c_str());
    ImGui::PopTextWrapPos();
    ImGui::End();
}

}  // namespace

void draw_messages(ViewState& state) {
    const float bottom = ImGui::GetIO().DisplaySize.y - margin * state.content_scale;
    if (!state.status.message.empty())
        draw_line("message", margin * state.content_scale, state.status.message,
                  state.status.is_error ? ImVec4(1, 0.5f, 0.4f, 1) : ImVec4(1, 1, 1, 1));
    else if (state.status.scene == 0)
        draw_line("message", margin * state.content_scale, "opening " + state.options.scene.string(),
                  {1, 1, 1, 1});
    if (glfwGetTime() - state.notice_at < notice_seconds)
        draw_line("notice", bottom, state.notice, {1, 1, 1, 1});
}

void draw_question(ViewState& state) {
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({size.x / 2, size.y / 2}, ImGuiCond_Always, {0.5f, 0.5f});
    ImGui::Begin("Class files", nullptr, fixed);
    ImGui::PushTextWrapPos(0.8f * size.x);
    ImGui::TextUnformatted(state.status.question.c_str());
    ImGui::PopTextWrapPos();
    if (ImGui::Button("Run them (Y)")) state.session.answer(true);
    ImGui::SameLine();
    if (ImGui::Button("Do not (N)")) state.session.answer(false);
    ImGui::End();
}

void draw_help(ViewState& state) {
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({size.x / 2, size.y / 2}, ImGuiCond_Always, {0.5f, 0.5f});
    ImGui::Begin(
        "Keys and mouse", &state.help,
        ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoCollapse);
    if (ImGui::BeginTable("shortcuts", 2)) {
        for (const auto& [keys, meaning] : shortcuts) {
            ImGui::TableNextColumn();
            ImGui::TextUnformatted(keys);
            ImGui::TableNextColumn();
            ImGui::TextUnformatted(meaning);
        }
        ImGui::EndTable();
    }
    ImGui::End();
}

void draw_panels(ViewState& state) {
    if (!state.panels) state.request.wants_errors = false;
    if (state.panels) {
        const float scale = state.content_scale;
        ImGui::SetNextWindowPos({margin * scale, margin * scale}, ImGuiCond_FirstUseEver);
        ImGui::SetNextWindowSizeConstraints(
            {panel_width * scale, 0},
            {panel_width * scale, ImGui::GetIO().DisplaySize.y - 2 * margin * scale});
        ImGui::Begin("étendue", &state.panels,
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize);
        ImGui::PushItemWidth(0.55f * panel_width * scale);
        draw_statistics_panel(state);
        draw_film_panel(state);
        draw_scene_panel(state);
        draw_camera_panel(state);
        draw_probe_panel(state);
        draw_rays_panel(state);
        draw_objects_panel(state);
        ImGui::TextDisabled("? lists the keys, Tab hides the panels");
        ImGui::PopItemWidth();
        ImGui::End();
    }
    if (state.rays.on) draw_rays(state);
    if (state.help) draw_help(state);
    if (state.picture && state.panels) {
        const ViewSettings shown = shown_settings(state);
        if (state.picture->layer >= Layer::linear)
            draw_polarization_scale(state, state.picture->layer);
        else if (shown.curve == ToneCurve::false_colors) {
            const bool is_error = state.picture->layer == Layer::error;
            draw_color_scale(state, shown.lowest, shown.highest,
                             is_error            ? "error / value"
                             : state.shows_meter ? shown_receiver(state)->unit.c_str()
                                                 : "cd/m²");
            if (state.shows_meter && state.isolines && !is_error) draw_isolines(state);
        }
    }
    draw_messages(state);
    if (!state.status.question.empty()) draw_question(state);
}

}  // namespace etendue
