#include "tests/support/device_fixture.h"

#include <cstdlib>

#include "tests/support/source_path.h"

namespace etendue {
namespace {

std::unique_ptr<Device> device;

}  // namespace

Device& test_device() {
    if (!device) {
        DeviceOptions options;
        options.validation = true;
        if (const char* selector = std::getenv("ETENDUE_DEVICE")) options.selector = selector;
        device = create_device(options);
        MESSAGE("device: ", device->description.name, ", ", device->description.driver);
    }
    return *device;
}

std::vector<std::string> collected_validation_messages() {
    return device ? device->validation_messages : std::vector<std::string>();
}

Kernel make_test_kernel(const std::string& name, const std::string& text, const BufferTable& buffers,
                        std::map<std::string, std::string> generated) {
    ShaderSources sources;
    sources.folder = source_path("shaders");
    sources.generated = std::move(generated);
    sources.generated[name] = text;
    return Kernel(test_device(), compile_shader(sources, name), buffers);
}

}  // namespace etendue
