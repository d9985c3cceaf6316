// etendue view: a window on a scene. The window is a module of its own, beside the executable.
#include <dlfcn.h>
#include <unistd.h>

#include <ctime>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "host/commands.h"
#include "host/error.h"
#include "host/image/atomic_file.h"
#include "host/interrupt.h"
#include "host/preview/view_module.h"

namespace etendue {

double seconds_since_start() {
    std::ifstream file("/proc/self/stat");
    std::string text;
    std::getline(file, text);
    // starttime, the twentieth field behind the name, in ticks since the machine started: proc(5).
    std::istringstream fields(text.substr(text.rfind(')') + 1));
    for (int i = 0; i < 20; ++i) fields >> text;
    timespec now;
    clock_gettime(CLOCK_BOOTTIME, &now);
    return double(now.tv_sec) + 1e-9 * double(now.tv_nsec) - std::stod(text) / double(sysconf(_SC_CLK_TCK));
}

int view_command(const ViewOptions& options) {
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
    return entry(options);
}

}  // namespace etendue
