// The ray viewer: recorded paths drawn over the picture, through bodies and all, there more faintly.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "host/preview/hidden_lines.h"
#include "host/preview/window/panels.h"

namespace etendue {
namespace {

constexpr PathEvent events[] = {PathEvent::reflected, PathEvent::refracted, PathEvent::straight,
                                PathEvent::scattered, PathEvent::entered,   PathEvent::left,
                                PathEvent::bent,      PathEvent::absorbed,  PathEvent::escaped};
constexpr double faintest = 0.05;         // of a line
constexpr double strength_behind = 0.25;  // surfaces, of that in front
constexpr double part_pixels = 4;         // that are hidden or not

template <class T>
bool checkbox(const char* label, std::set<T>& chosen, const T& value) {
    bool on = chosen.count(value) > 0;
    if (!ImGui::Checkbox(label, &on)) return false;
    if (on)
        chosen.insert(value);
    else
        chosen.erase(value);
    return true;
}

// Everything that paths can meet by name.
std::vector<std::string> object_names(const ViewState& state) {
    std::set<std::string> names(state.status.placed_names.begin(), state.status.placed_names.end());
    for (const LiveObject& object : state.objects)
        if (!object.name.empty() && object.part != LiveObject::Part::receiver) names.insert(object.name);
    return {names.begin(), names.end()};
}

// `behind`: a surface.
ImU32 line_paint(const ViewState& state, const RecordedPath& path, const PathVertex& vertex, bool behind) {
    glm::vec3 color = line_color(path, vertex);
    double strength = 0.6;
    if (state.rays.by_power) {
        const double start = path.vertices.front().leaving;
        color = glm::vec3(1.0f, 0.9f, 0.3f);
        strength = start > 0 ? std::clamp(vertex.leaving / start, faintest, 1.0) : faintest;
    }
    if (behind) strength *= strength_behind;
    const auto encoded = [](float x) {
        return int(std::lround(255 * std::pow(std::clamp(x, 0.0f, 1.0f), 1 / 2.2f)));
    };
    return IM_COL32(encoded(color.x), encoded(color.y), encoded(color.z), int(255 * strength));
}

}  // namespace

void draw_rays(ViewState& state) {
    const PreviewReceiver* receiver = shown_receiver(state);
    if (!receiver || state.request.height == 0) return;
    ImDrawList* list = ImGui::GetBackgroundDrawList();
    const ImVec2 window = ImGui::GetIO().DisplaySize;
    const double aspect = double(window.x) / window.y;
    const PreviewPicture* picture = state.picture.get();
    // Of another view the depths would be wrong ones.
    const bool parts = state.rays.faint_behind && picture && !picture->depth.empty() &&
                       picture->request.shows_the_same(state.request);
    for (const RecordedPath& path : state.rays.paths)
        for (size_t i = 0; i + 1 < path.vertices.size(); ++i) {
            const auto line = seen_line(state.pose, receiver->lens, aspect, path.vertices[i].position,
                                        path.vertices[i + 1].position);
            if (!line) continue;
            const auto draw = [&](const LinePart& part) {
                const glm::dvec2 from = glm::clamp(part.from * double(window.y), -1e5, 1e5),
                                 to = glm::clamp(part.to * double(window.y), -1e5, 1e5);
                list->AddLine({float(from.x), float(from.y)}, {float(to.x), float(to.y)},
                              line_paint(state, path, path.vertices[i], part.hidden), state.content_scale);
            };
            if (!parts)
                draw({line->at[0], line->at[1], false});
            else
                for (const LinePart& part :
                     part_by_depth(*line, receiver->lens, aspect,
                                   {picture->width, picture->height, picture->depth}, part_pixels / window.y))
                    draw(part);
        }
}

void draw_rays_panel(ViewState& state) {
    if (!ImGui::CollapsingHeader("Rays")) return;
    RayView& rays = state.rays;
    bool changed = ImGui::Checkbox("show", &rays.on);
    ImGui::SameLine();
    ImGui::TextDisabled("%s", rays.is_made ? "tracing" : fmt::format("{} paths", rays.paths.size()).c_str());
    int direction = rays.forward;
    changed |= ImGui::RadioButton("from the receiver", &direction, 0);
    ImGui::SameLine();
    changed |= ImGui::RadioButton("from lights", &direction, 1);
    rays.forward = direction != 0;
    changed |= ImGui::SliderInt("paths", &rays.count, 1, 10000, "%d", ImGuiSliderFlags_Logarithmic);
    ImGui::Checkbox("brightness by power", &rays.by_power);
    ImGui::Checkbox("fainter behind surfaces", &rays.faint_behind);
    if (ImGui::TreeNode("that were")) {
        for (const PathEvent event : events)
            changed |= checkbox(event_name(event), rays.filter.events, event);
        ImGui::TreePop();
    }
    if (ImGui::TreeNode("at")) {
        for (const std::string& name : object_names(state))
            changed |= checkbox(name.c_str(), rays.filter.objects, name);
        ImGui::TreePop();
    }
    if (ImGui::TreeNode("but never at")) {
        for (const std::string& name : object_names(state))
            changed |= checkbox(name.c_str(), rays.filter.without, name);
        ImGui::TreePop();
    }
    if (ImGui::Button("Trace again")) changed = true;
    if (changed && rays.on) trace_paths(state);
}

}  // namespace etendue
