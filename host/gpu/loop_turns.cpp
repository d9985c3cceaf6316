#include "host/gpu/loop_turns.h"

#include "host/gpu/buffer.h"
#include "host/gpu/kernel.h"

namespace etendue {
namespace {

constexpr uint32_t turns_wanted = 100000;

const char* const text = R"(
    layout(local_size_x = 1) in;
    layout(push_constant) uniform Push { uint wanted; };
    layout(scalar, set = 0) buffer Turns { uint made, none; };
    void main() {
        uint turns = 0u;
        while (turns < wanted) turns += 1u + none;  // no compiler knows how often
        made = turns;
    }
)";

bool may_count(const Device& device) {
    VkPhysicalDeviceDriverProperties driver{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
    VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &driver};
    vkGetPhysicalDeviceProperties2(device.physical, &properties);
    return driver.driverID == VK_DRIVER_ID_MESA_LLVMPIPE &&
           properties.properties.driverVersion < VK_MAKE_VERSION(25, 0, 0);
}

}  // namespace

uint32_t find_max_loop_turns(Device& device) {
    if (!may_count(device)) return 0;
    ShaderSources sources;
    sources.generated["count_turns"] = text;
    Buffer turns = create_buffer(device, std::vector<uint32_t>{0, 0}, "Turns");
    const Kernel kernel(device, compile_shader(sources, "count_turns"), {{"Turns", &turns}});
    CommandList commands(device);
    commands.dispatch(kernel, 1, {{"wanted", turns_wanted}});
    commands.run();
    const uint32_t made = turns.read_array<uint32_t>(1)[0];
    return made < turns_wanted ? made : 0;
}

}  // namespace etendue
