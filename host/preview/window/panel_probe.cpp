#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/image/polarization.h"
#include "host/preview/window/panels.h"
#include "host/spectra/color.h"

namespace etendue {
namespace {

void draw_values(const PreviewPicture& picture, size_t at) {
    const glm::vec3& v = picture.radiance[at];
    ImGui::Text("value %.4g %.4g %.4g", double(v.x), double(v.y), double(v.z));
    ImGui::Text("luminance %.4g cd/m²", luminance(glm::dvec3(v)));
    if (at < picture.errors.size())
        ImGui::Text("error +- %.2g cd/m²", luminance(glm::dvec3(picture.errors[at])));
    else
        ImGui::TextUnformatted("error not known yet");
    if (at >= picture.stokes.size()) return;
    const glm::dvec4 s(picture.stokes[at]);
    const PolarizationState state = polarization_state(s);
    ImGui::Text("S1 to S3 %.4g %.4g %.4g cd/m²", s[1], s[2], s[3]);
    ImGui::Text("linear %.3g at %.1f°, circular %.3g", double(state.linear),
                double(state.angle) * 180 / std::numbers::pi, double(state.circular));
}

}  // namespace

void draw_probe_panel(ViewState& state) {
    const bool open = ImGui::CollapsingHeader("Pixel under the pointer");
    state.request.wants_errors = open;
    if (!open || !state.picture) return;
    const PreviewPicture& picture = *state.picture;
    const double u = state.pointer_x / std::max(1u, picture.request.width),
                 v = state.pointer_y / std::max(1u, picture.request.height);
    if (!(u >= 0 && u < 1 && v >= 0 && v < 1) || ImGui::GetIO().WantCaptureMouse) {
        ImGui::TextUnformatted("point at the picture");
        return;
    }
    read_pixel_at_pointer(state);
    const uint32_t x = uint32_t(u * picture.width), y = uint32_t(v * picture.height);
    ImGui::Text("pixel %d, %d", int(state.pointer_x), int(state.pointer_y));
    draw_values(picture, size_t(y) * picture.width + x);
    if (!state.reading) return;
    const PixelReading& reading = *state.reading;
    if (!reading.seen.hit) {
        ImGui::TextUnformatted("sees nothing but the surroundings");
    } else {
        ImGui::Text("sees %s: %s", reading.material.c_str(), reading.surface_class.c_str());
        const glm::dvec3& p = reading.seen.position;
        ImGui::Text("at %.4g %.4g %.4g m", p.x, p.y, p.z);
        ImGui::Text("in %.4g m", double(reading.seen.distance));
    }
    if (reading.spectrum.empty()) return;
    ImGui::PlotLines("##spectrum", reading.spectrum.data(), int(reading.spectrum.size()), 0, nullptr, 0,
                     *std::max_element(reading.spectrum.begin(), reading.spectrum.end()),
                     {0, 80 * state.content_scale});
    ImGui::TextUnformatted("360 to 830 nm, W/(m² sr nm)");
}

}  // namespace etendue
