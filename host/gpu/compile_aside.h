// Has a driver finish compiling kernels on all cores. lavapipe compiles a kernel at its first dispatch, on
// the one thread of the device that dispatches it, and keeps the result on disk: so other devices, a thread
// each, dispatch them on nothing before.
#pragma once
#include <filesystem>
#include <vector>

#include "host/gpu/device.h"

namespace etendue {

// Kernels in SPIR-V files as CompiledShader::file. Returns when all are compiled, the largest first; at once
// where the device is none that gains by it, or there is but one. What cannot be compiled is left to those
// who dispatch it.
void compile_aside(const Device& device, std::vector<std::filesystem::path> spirv);

}  // namespace etendue
