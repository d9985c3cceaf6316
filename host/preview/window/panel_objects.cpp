#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "host/preview/window/panels.h"

namespace etendue {
namespace {

using Part = LiveObject::Part;
constexpr std::pair<Part, const char*> parts[] = {
    {Part::surface, "surfaces"},  {Part::emission, "emission"}, {Part::boundary, "media and priorities"},
    {Part::medium, "media"},      {Part::place, "places"},      {Part::phase, "phase functions"},
    {Part::geometry, "shapes"},   {Part::light, "lights"},      {Part::environment, "environment"},
    {Part::receiver, "receivers"}};

bool is_numbers(const nlohmann::json& value, size_t count) {
    return value.is_array() && value.size() == count &&
           std::all_of(value.begin(), value.end(), [](auto& v) { return v.is_number(); });
}

bool edit_number(const char* label, const Parameter& p, nlohmann::json& value) {
    const bool whole = p.member.type == "uint" || p.member.type == "int";
    double number = value.get<double>();
    const double lo = std::isfinite(p.lo) ? p.lo : -1e30, hi = std::isfinite(p.hi) ? p.hi : 1e30;
    const bool bounded = std::isfinite(p.lo) && std::isfinite(p.hi);
    const float speed = float(bounded ? (p.hi - p.lo) / 200 : std::max(std::abs(number) / 100, 1e-3));
    if (!ImGui::DragScalar(label, ImGuiDataType_Double, &number, speed, &lo, &hi, whole ? "%.0f" : "%.4g"))
        return false;
    value = whole ? nlohmann::json(std::llround(number)) : nlohmann::json(number);
    return true;
}

// Three numbers: a colour, or a vector.
bool edit_three(const char* label, const Parameter& p, nlohmann::json& value) {
    float v[3];
    for (size_t i = 0; i < 3; ++i) v[i] = value[i].get<float>();
    const bool is_color = p.member.type == "SpectrumRef";
    const bool changed =
        is_color ? ImGui::ColorEdit3(label, v, ImGuiColorEditFlags_Float | ImGuiColorEditFlags_HDR)
                 : ImGui::DragFloat3(label, v, 0.01f, 0, 0, "%.3g");
    if (changed) value = {v[0], v[1], v[2]};
    return changed;
}

// Anything else, as it stands in a scene file; taken over with Enter.
bool edit_text(const char* label, nlohmann::json& value) {
    char text[256];
    std::snprintf(text, sizeof text, "%s", value.dump().c_str());
    if (!ImGui::InputText(label, text, sizeof text, ImGuiInputTextFlags_EnterReturnsTrue)) return false;
    nlohmann::json given = nlohmann::json::parse(text, nullptr, false);
    value = given.is_discarded() ? nlohmann::json(text) : given;
    return true;
}

// One of the scene's media, or none.
bool edit_medium(const ViewState& state, const char* label, nlohmann::json& value) {
    const std::string now = value.is_string() ? value.get<std::string>() : "";
    std::string chosen = now;
    if (!ImGui::BeginCombo(label, now.empty() ? "none" : now.c_str())) return false;
    if (ImGui::Selectable("none", now.empty())) chosen = "";
    for (const LiveObject& object : state.objects)
        if (object.part == Part::medium && ImGui::Selectable(object.name.c_str(), object.name == now))
            chosen = object.name;
    ImGui::EndCombo();
    value = chosen;
    return chosen != now;
}

bool edit_value(const ViewState& state, const Parameter& p, nlohmann::json& value) {
    const char* label = p.member.name.c_str();
    if (p.member.type == "medium") return edit_medium(state, label, value);
    if (value.is_boolean()) {
        bool on = value.get<bool>();
        if (!ImGui::Checkbox(label, &on)) return false;
        value = on;
        return true;
    }
    if (value.is_number()) return edit_number(label, p, value);
    if (is_numbers(value, 3)) return edit_three(label, p, value);
    return edit_text(label, value);
}

void draw_class(ViewState& state, LiveObject& object) {
    const auto names = state.status.class_names.find(interface_of(object.part));
    const bool fixed =
        object.part == Part::receiver || object.part == Part::phase || object.class_name.empty();
    if (fixed || names == state.status.class_names.end()) {
        if (!object.class_name.empty()) ImGui::TextUnformatted(object.class_name.c_str());
        return;
    }
    if (!ImGui::BeginCombo("class", object.class_name.c_str())) return;
    for (const std::string& name : names->second)
        if (ImGui::Selectable(name.c_str(), name == object.class_name) && name != object.class_name)
            edit_object(state, {object, "", name});
    ImGui::EndCombo();
}

void draw_object(ViewState& state, LiveObject& object) {
    const char* colon = object.name.empty() || object.class_name.empty() ? "" : ": ";
    const std::string label =
        fmt::format("{}{}{}###{}-{}", object.name, colon, object.class_name, int(object.part), object.index);
    if (!ImGui::TreeNode(label.c_str())) return;
    draw_class(state, object);
    for (LiveParameter& parameter : object.parameters) {
        if (parameter.info.member.type == "TextureRef" && parameter.value.is_null()) continue;
        if (edit_value(state, parameter.info, parameter.value))
            edit_object(state, {object, parameter.info.member.name, parameter.value});
        if (ImGui::IsItemHovered())
            ImGui::SetTooltip("%s", fmt::format("{} {} {}", parameter.info.text, parameter.info.unit,
                                                parameter.info.range())
                                        .c_str());
    }
    ImGui::TreePop();
}

}  // namespace

void draw_objects_panel(ViewState& state) {
    if (!ImGui::CollapsingHeader("Objects")) return;
    for (const auto& [part, name] : parts) {
        const auto count = std::count_if(state.objects.begin(), state.objects.end(),
                                         [part = part](auto& o) { return o.part == part; });
        if (count == 0 || !ImGui::TreeNode(name, "%s (%d)", name, int(count))) continue;
        for (LiveObject& object : state.objects)
            if (object.part == part) draw_object(state, object);
        ImGui::TreePop();
    }
}

}  // namespace etendue
