// etendue classes, etendue devices: what there is.
#include <fmt/core.h>

#include <algorithm>

#include "host/commands.h"
#include "host/error.h"
#include "host/gpu/device.h"
#include "host/scene/classes.h"

namespace etendue {
namespace {

void print_class(const ClassInfo& info) {
    fmt::print("{} {}  (tag {}, {}, record {} of {} bytes)\n", interface_info(info.interface).name, info.name,
               info.tag, info.file, info.record, info.stride);
    std::string summary = "    " + info.summary;
    for (size_t at = 0; (at = summary.find('\n', at)) != std::string::npos; at += 5)
        summary.replace(at, 1, "\n    ");
    fmt::print("{}\n", summary);
    for (const Parameter& p : info.parameters) {
        if (!p.from_scene) continue;
        std::string line = fmt::format("  {:<12} {:<26} {}", p.member.type, p.member.name, p.shown_default());
        if (const std::string range = p.range(); !range.empty()) line += " in " + range;
        if (!p.unit.empty()) line += " " + p.unit;
        fmt::print("{}\n      {}\n", line, p.text);
    }
    fmt::print("\n");
}

}  // namespace

int classes_command(const ClassesOptions& options) {
    ShaderSources sources;
    sources.folder = options.shaders;
    ClassRegistry registry(sources);
    bool found = false;
    for (const InterfaceInfo& interface : all_interfaces()) {
        const auto& classes = registry.classes(interface.interface);
        if (options.name.empty()) fmt::print("{}{}\n", interface.name, classes.empty() ? ": none" : "");
        for (const ClassInfo& listed : classes) {
            if (!options.name.empty() && listed.name != options.name) continue;
            const ClassInfo& info = *registry.find(interface.interface, listed.name);  // compiles it
            found = true;
            if (options.name.empty())
                fmt::print("    {:<19} {}\n", info.name, first_sentence(info.summary));
            else
                print_class(info);
        }
    }
    if (!options.name.empty() && !found)
        fail_input("classes {}: no such class; `etendue classes` lists them", options.name);
    return 0;
}

int devices_command() {
    const auto devices = list_devices();
    if (devices.empty())
        fail_device("no Vulkan device found; install a driver (on Debian: mesa-vulkan-drivers)");
    const int chosen = default_device(devices);
    for (const DeviceDescription& d : devices) {
        fmt::print("{} {}{}\n    {}, {}, Vulkan {}.{}, subgroups of {}, {:.1f} GiB, {:.0f} MiB a binding\n",
                   d.index, d.name, int(d.index) == chosen ? " (default)" : "", d.type, d.driver,
                   VK_API_VERSION_MAJOR(d.api_version), VK_API_VERSION_MINOR(d.api_version), d.subgroup_size,
                   double(d.memory) / (1 << 30), double(d.max_buffer_range) / (1 << 20));
        if (!d.missing.empty()) fmt::print("    not usable: lacks {}\n", fmt::join(d.missing, ", "));
    }
    return 0;
}

}  // namespace etendue
