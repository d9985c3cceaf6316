#include "host/gpu/shader_source.h"

#include <fstream>
#include <sstream>
#include <string_view>

#include "host/embedded_files.h"
#include "host/error.h"

namespace etendue {

std::optional<std::string> ShaderSources::find(const std::string& name) const {
    if (auto found = generated.find(name); found != generated.end()) return found->second;
    if (!folder.empty()) {
        std::ifstream file(folder / name, std::ios::binary);
        if (file) return (std::ostringstream() << file.rdbuf()).str();
    }
    for (const EmbeddedFile& file : embedded_shaders())
        if (std::string_view(file.name) == name) return file.text;
    return std::nullopt;
}

std::string ShaderSources::get(const std::string& name) const {
    if (auto text = find(name)) return *text;
    fail_input("{}: no such shader file", name);
}

}  // namespace etendue
