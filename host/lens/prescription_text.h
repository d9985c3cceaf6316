// What the readers of lens files share.
#pragma once
#include "host/lens/prescription.h"
#include "host/text_lines.h"

namespace etendue {

Prescription read_zmx(const TextLines& text);
Prescription read_seq(const TextLines& text);
Prescription read_lens_table(const TextLines& text);

std::vector<std::string> words_of(const std::string& line);  // parted by blanks and commas
std::string upper(std::string text);

// By nd and vd, as lens files write them: "517642" or "517000.642000"; none where `code` is no such number.
std::optional<Glass> coded_glass(const std::string& code);

// A glass of the catalogue, or by its code; fails where it has no data.
Glass required_glass(const TextLines& text, size_t line, const std::string& name,
                     std::span<const std::string> makers);

// Right-handed, about an axis (0 x, 1 y, 2 z), in degrees.
glm::dmat3 turn_about(int axis, double degrees);

// What every reader leaves to be done: labels, an image, a field and a wavelength where there are none; fails
// where something is missing. Lengths are scaled by `mm`, the unit of the file.
void finish_prescription(const TextLines& text, Prescription& p, double mm);

}  // namespace etendue
