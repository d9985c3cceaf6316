// etendue devices: what there is to render on.
#include <fmt/core.h>
#include <fmt/ranges.h>

#include "host/commands.h"
#include "host/error.h"
#include "host/gpu/device.h"

namespace etendue {

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
