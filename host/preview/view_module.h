// What `etendue view` loads at run time, so that no other command needs a window library: libetendue_view.so,
// which takes everything but the window itself from the executable.
#pragma once
#include "host/options.h"

// Shows the scene until the window is closed; the exit code. Errors leave as Error.
extern "C" int etendue_view(const etendue::ViewOptions& options);

namespace etendue {

inline constexpr const char* view_module_name = "libetendue_view.so";
inline constexpr const char* view_module_entry = "etendue_view";
double seconds_since_start();  // of the process, with up to 0.01 s too much

}  // namespace etendue
