#include "host/gpu/compile_aside.h"

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <thread>

#include "host/error.h"
#include "host/gpu/kernel.h"

namespace etendue {
namespace {

void dispatch_on_nothing(Device& device, const CompiledShader& shader, const Buffer& nothing) {
    BufferTable buffers;
    for (const BlockLayout& block : reflect_shader(shader.spirv).blocks) buffers[block.name] = &nothing;
    const Kernel kernel(device, shader, buffers);
    CommandList commands(device);
    commands.dispatch(kernel, 0);
    commands.run();
}

bool keeps_on_disk(const Device& device) {
    const char* disabled = std::getenv("MESA_SHADER_CACHE_DISABLE");
    return device.description.name.find("llvmpipe") != std::string::npos && !(disabled && *disabled);
}

}  // namespace

void compile_aside(const Device& device, std::vector<std::filesystem::path> spirv) {
    if (spirv.size() < 2 || !keeps_on_disk(device)) return;
    std::vector<CompiledShader> shaders;
    for (const auto& file : spirv)
        if (auto shader = read_cached_shader(file)) shaders.push_back(std::move(*shader));
    std::sort(shaders.begin(), shaders.end(),
              [](const auto& a, const auto& b) { return a.spirv.size() > b.spirv.size(); });
    std::atomic<size_t> next = 0;
    const auto work = [&] {
        try {
            const auto own = create_device({device.description.name, false});
            const Buffer nothing(*own, 4096, "Nothing");
            for (size_t i; (i = next++) < shaders.size();) dispatch_on_nothing(*own, shaders[i], nothing);
        } catch (const Error&) {
        }
    };
    std::vector<std::jthread> threads;
    const size_t cores = std::max(1u, std::thread::hardware_concurrency());
    for (size_t i = 0; i < std::min(cores, shaders.size()); ++i) threads.emplace_back(work);
}

}  // namespace etendue
