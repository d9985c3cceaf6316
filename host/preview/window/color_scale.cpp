// The scale of false colours: decades of cd/m², or of relative error, along a bar at the window's right side.
#include <fmt/format.h>
#include <imgui.h>

#include <cmath>

#include "host/preview/window/panels.h"

namespace etendue {
namespace {

// Twin of turbo() in shaders/view/tone_curves.glsl, for a legend.
ImU32 legend_color(double x) {
    const double c[3][6] = {{0.13572138, 4.61539260, -42.66032258, 132.13108234, -152.94239396, 59.28637943},
                            {0.09140261, 2.19418839, 4.84296658, -14.18503333, 4.27729857, 2.82956604},
                            {0.10667330, 12.64194608, -60.58204836, 110.36276771, -89.90310912, 27.34824973}};
    int bytes[3];
    for (int i = 0; i < 3; ++i) {
        double y = 0;
        for (int k = 5; k >= 0; --k) y = y * x + c[i][k];
        bytes[i] = int(std::lround(255 * std::fmin(std::fmax(y, 0), 1)));
    }
    return IM_COL32(bytes[0], bytes[1], bytes[2], 255);
}

}  // namespace

void draw_color_scale(ViewState& state, double lowest, double highest, const char* unit) {
    const ImVec2 window = ImGui::GetIO().DisplaySize;
    const float scale = state.content_scale, width = 16 * scale, right = window.x - 80 * scale,
                top = 40 * scale, height = window.y - 80 * scale;
    if (height <= 0) return;
    ImDrawList* list = ImGui::GetBackgroundDrawList();
    constexpr int strips = 64;
    for (int i = 0; i < strips; ++i)
        list->AddRectFilled({right, top + height * float(i) / strips},
                            {right + width, top + height * float(i + 1) / strips},
                            legend_color(1 - (i + 0.5) / strips));
    const double range = std::log10(highest / lowest);
    const auto label = [&](double value, const std::string& text) {
        const float y = top + height * float(1 - std::log10(value / lowest) / range);
        list->AddLine({right + width, y}, {right + width + 5 * scale, y}, IM_COL32_WHITE, scale);
        const ImVec2 at(right + width + 8 * scale, y - 7 * scale);
        list->AddText({at.x + scale, at.y + scale}, IM_COL32_BLACK, text.c_str());
        list->AddText(at, IM_COL32_WHITE, text.c_str());
    };
    for (int decade = int(std::ceil(std::log10(lowest) - 1e-6));
         decade <= int(std::floor(std::log10(highest) + 1e-6)); ++decade)
        label(std::pow(10.0, decade), fmt::format("{:g}", std::pow(10.0, decade)));
    list->AddText({right - 10 * scale, top - 20 * scale}, IM_COL32_WHITE, unit);
}

}  // namespace etendue
