// etendue view: a window on a scene. The window is a module of its own, beside the executable.
#include <dlfcn.h>

#include <chrono>
#include <filesystem>

#include "host/commands.h"
#include "host/error.h"
#include "host/image/atomic_file.h"
#include "host/interrupt.h"
#include "host/preview/view_module.h"

namespace etendue {

double seconds_now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

int view_command(const ViewOptions& options) {
    const double started = seconds_now();
    if (!options.stats.empty()) check_writable(options.stats);
    catch_interrupts();
    std::error_code error;
    const auto folder = std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
    const std::filesystem::path beside = folder / view_module_name;
    // Never closed: what it leaves behind may refer to its code.
    void* module = dlopen(beside.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!module) fail_device("the window cannot be loaded: {}", dlerror());
    const auto entry = reinterpret_cast<decltype(&etendue_view)>(dlsym(module, view_module_entry));
    if (!entry) fail_device("the window cannot be loaded: {}", dlerror());
    return entry(options, started);
}

}  // namespace etendue
