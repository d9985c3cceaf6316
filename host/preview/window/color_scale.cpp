// The scale of false colours along a bar at the window's right side: decades of cd/m² or of relative error,
// degrees and angles of polarization.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "host/image/polarization.h"
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

ImU32 screen_color(const glm::vec3& encoded) {
    return IM_COL32(int(255 * encoded.x + 0.5f), int(255 * encoded.y + 0.5f), int(255 * encoded.z + 0.5f),
                    255);
}

// The bar, and labels beside it; places along it run from 0, at its lower end, to 1.
class Bar {
  public:
    Bar(const ViewState& state, const std::function<ImU32(double)>& color, const char* unit)
        : scale_(state.content_scale),
          right_(ImGui::GetIO().DisplaySize.x - 80 * scale_),
          top_(40 * scale_),
          height_(std::max(0.0f, ImGui::GetIO().DisplaySize.y - 80 * scale_)) {
        if (height_ == 0) return;
        constexpr int strips = 64;
        for (int i = 0; i < strips; ++i)
            list_->AddRectFilled({right_, top_ + height_ * float(i) / strips},
                                 {right_ + width(), top_ + height_ * float(i + 1) / strips},
                                 color(1 - (i + 0.5) / strips));
        list_->AddText({right_ - 10 * scale_, top_ - 20 * scale_}, IM_COL32_WHITE, unit);
    }
    void label(double place, const std::string& text) {
        if (height_ == 0) return;
        const float y = top_ + height_ * float(1 - place);
        list_->AddLine({right_ + width(), y}, {right_ + width() + 5 * scale_, y}, IM_COL32_WHITE, scale_);
        const ImVec2 at(right_ + width() + 8 * scale_, y - 7 * scale_);
        list_->AddText({at.x + scale_, at.y + scale_}, IM_COL32_BLACK, text.c_str());
        list_->AddText(at, IM_COL32_WHITE, text.c_str());
    }

  private:
    float width() const { return 16 * scale_; }
    ImDrawList* list_ = ImGui::GetBackgroundDrawList();
    float scale_, right_, top_, height_;
};

}  // namespace

void draw_color_scale(ViewState& state, double lowest, double highest, const char* unit) {
    Bar bar(state, legend_color, unit);
    const double range = std::log10(highest / lowest);
    for (const double mark : scale_marks(lowest, highest))
        if (range < 3.5 || std::fabs(std::log10(mark) - std::round(std::log10(mark))) < 1e-6)
            bar.label(std::log10(mark / lowest) / range, fmt::format("{:g}", mark));
}

void draw_isolines(ViewState& state) {
    ImDrawList* list = ImGui::GetBackgroundDrawList();
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    const auto place = [&](const glm::vec2& p) { return ImVec2(p.x * size.x, p.y * size.y); };
    for (const double mark : scale_marks(state.view.lowest, state.view.highest)) {
        const std::vector<LinePiece> pieces = isoline(state.values, mark);
        for (const LinePiece& piece : pieces)
            list->AddLine(place(piece.from), place(piece.to), IM_COL32(255, 255, 255, 200),
                          1.5f * state.content_scale);
        if (pieces.empty()) continue;
        const std::string text = fmt::format("{:g}", mark);
        const ImVec2 at = place(pieces[pieces.size() / 2].from);
        list->AddText({at.x + 1, at.y + 1}, IM_COL32_BLACK, text.c_str());
        list->AddText(at, IM_COL32_WHITE, text.c_str());
    }
}

void draw_polarization_scale(ViewState& state, Layer layer) {
    if (layer == Layer::angle) {
        Bar bar(
            state, [](double x) { return screen_color(angle_color(x * std::numbers::pi)); }, "angle, °");
        for (int degrees = 0; degrees <= 180; degrees += 45)
            bar.label(degrees / 180.0, std::to_string(degrees));
    } else if (layer == Layer::circular) {
        Bar bar(
            state, [](double x) { return screen_color(signed_degree_color(2 * x - 1)); }, "circular");
        bar.label(1, "1 right"), bar.label(0.5, "0"), bar.label(0, "-1 left");
    } else {
        Bar bar(
            state, [](double x) { return screen_color(degree_color(x)); }, "linear");
        for (double x : {0.0, 0.25, 0.5, 0.75, 1.0}) bar.label(x, fmt::format("{:g}", x));
    }
}

}  // namespace etendue
