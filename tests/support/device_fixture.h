// The device of a test run: one per process, with the validation layer on. The run fails when the layer
// says anything. The environment variable ETENDUE_DEVICE chooses another device, as --device does.
#pragma once
#include <doctest/doctest.h>

#include "host/gpu/device.h"
#include "host/gpu/kernel.h"

namespace etendue {

// Made at first use. Without a device the test fails: nothing is skipped.
Device& test_device();

// What the validation layer has said so far; the test run fails unless it is empty.
std::vector<std::string> collected_validation_messages();

// Compiles a kernel of the tests: `text` is GLSL that may include anything under shaders/ and `generated`
// files.
Kernel make_test_kernel(const std::string& name, const std::string& text, const BufferTable& buffers,
                        std::map<std::string, std::string> generated = {});

}  // namespace etendue
