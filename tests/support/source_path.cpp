#include "tests/support/source_path.h"

#include <cstdlib>

namespace etendue {

std::string source_path(const std::string& name) {
    const char* given = std::getenv("ETENDUE_SOURCE");
    return std::string(given ? given : ETENDUE_SOURCE_DIR) + "/" + name;
}

}  // namespace etendue
