#include <imgui.h>

#include <cmath>

#include "host/preview/window/panels.h"

namespace etendue {

void draw_statistics_panel(ViewState& state) {
    const PreviewStatus& s = state.status;
    if (!ImGui::CollapsingHeader("Render", ImGuiTreeNodeFlags_DefaultOpen)) return;
    ImGui::Text("%llu pass%s%s", (unsigned long long)s.passes, s.passes == 1 ? "" : "es",
                s.at_rest ? ", at rest" : "");
    if (s.error && std::isfinite(s.error->value()))
        ImGui::Text("relative error %.3g", s.error->value());
    else
        ImGui::TextUnformatted("relative error not known yet");
    ImGui::Text("%.2f million rays/s", s.rays_per_second * 1e-6);
    if (state.picture)
        ImGui::Text("%u x %u pixels%s", state.picture->width, state.picture->height,
                    s.step > 1 ? ", enlarged" : "");
    ImGui::Text("%s, %s", algorithm_name(s.choice.algorithm), schedule_name(s.schedule));
    if (!s.choice.reason.empty() && ImGui::IsItemHovered()) ImGui::SetTooltip("%s", s.choice.reason.c_str());
    ImGui::Text("%llu triangles, %llu shapes, %llu lights", (unsigned long long)s.triangles,
                (unsigned long long)s.shapes, (unsigned long long)s.lights);
    ImGui::TextWrapped("%.1f MiB on %s", double(s.device_bytes) / 1048576.0, s.device.c_str());
    if (ImGui::TreeNode("time of kernels")) {
        for (const auto& [name, timing] : s.timings)
            ImGui::Text("%-20s %8.3f s %6llu x", name.c_str(), timing.seconds,
                        (unsigned long long)timing.dispatches);
        ImGui::TreePop();
    }
    if (ImGui::TreeNode("compiled kernels")) {
        for (const KernelReport& kernel : s.kernels)
            ImGui::Text("%-20s %6.1f KiB %s", kernel.name.c_str(), double(kernel.spirv_bytes) / 1024,
                        kernel.from_cache ? "from the cache" : "");
        ImGui::TreePop();
    }
}

}  // namespace etendue
