#include "host/preview/window/font.h"

#include <imgui.h>

#include <cmath>
#include <filesystem>

namespace etendue {
namespace {

constexpr float font_pixels = 13;       // of a display of 96 dpi; what the built-in bitmap is drawn for
constexpr const char* font_files[] = {  // the first that is there; DejaVu is what tools/setup.sh installs
    "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
    "/usr/share/fonts/TTF/DejaVuSans.ttf",
    "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf",
    "/usr/share/fonts/truetype/noto/NotoSans-Regular.ttf",
    "/usr/share/fonts/noto/NotoSans-Regular.ttf",
    "/usr/share/fonts/truetype/liberation/LiberationSans-Regular.ttf"};
// Latin with its accents, Greek, and signs of units and of texts: first and last of each range.
constexpr ImWchar letters[] = {0x20,   0x24F,  0x370,  0x3FF,  0x2010, 0x2027, 0x2030, 0x203A, 0x2070,
                               0x209F, 0x2190, 0x2193, 0x2202, 0x2202, 0x2206, 0x2206, 0x2211, 0x2212,
                               0x221A, 0x221E, 0x222B, 0x222B, 0x2248, 0x2248, 0x2260, 0x2265, 0};

const char* font_file() {
    std::error_code error;
    for (const char* file : font_files)
        if (std::filesystem::is_regular_file(file, error)) return file;
    return nullptr;
}

}  // namespace

void load_font(float scale) {
    ImFontAtlas& fonts = *ImGui::GetIO().Fonts;
    fonts.Clear();
    ImFontConfig config;
    config.OversampleH = 2;
    const char* file = font_file();
    const float pixels = std::floor(font_pixels * scale);
    if (file && fonts.AddFontFromFileTTF(file, pixels, &config, letters) && fonts.Build()) return;
    // The built-in bitmap: Latin alone, and coarse where it is enlarged.
    fonts.Clear();
    config.SizePixels = pixels;
    fonts.AddFontDefault(&config);
}

}  // namespace etendue
