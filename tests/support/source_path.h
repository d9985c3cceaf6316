// Where tests find the shaders, scenes and kernels of the checkout.
#pragma once
#include <string>

namespace etendue {

// The whole path of `name`, a file or folder of the checkout that the tests were built from, or of the folder that the environment
// variable ETENDUE_SOURCE names.
std::string source_path(const std::string& name);

}  // namespace etendue
