// The letters of the panels: a vector font of the machine, as large as the display asks for.
#pragma once

namespace etendue {

// Makes them anew. `scale`: of the display, 1 for one of 96 dpi. Whoever draws uploads them again.
void load_font(float scale);

}  // namespace etendue
