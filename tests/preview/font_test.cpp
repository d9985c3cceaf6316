// The letters of the window: those that panels, names and units need, as large as the display asks for.
#include "host/preview/window/font.h"

#include <doctest/doctest.h>
#include <imgui.h>

#include <initializer_list>

using namespace etendue;

TEST_CASE("the window's font has accents, Greek and the signs of units, and grows with the display") {
    ImGui::CreateContext();
    load_font(1);
    const ImFont* font = ImGui::GetIO().Fonts->Fonts.front();
    for (const ImWchar letter :
         {L'e', L'é', L'ß', L'µ', L'²', L'°', L'Ω', L'λ', L'θ', L'ł', L'≤', L'…', L'–', L'×'}) {
        CAPTURE(unsigned(letter));
        CHECK(font->FindGlyphNoFallback(letter) != nullptr);
    }
    // The atlas is made anew: what is to be compared is taken before.
    const float size = font->FontSize, width = font->CalcTextSizeA(size, 1e9f, 0, "étendue").x;
    load_font(2);  // drawn anew, not enlarged
    const ImFont* large = ImGui::GetIO().Fonts->Fonts.front();
    CHECK(large->FontSize == 2 * size);
    CHECK(large->Scale == 1);
    CHECK(large->CalcTextSizeA(large->FontSize, 1e9f, 0, "étendue").x ==
          doctest::Approx(2 * width).epsilon(0.05));
    ImGui::DestroyContext();
}
