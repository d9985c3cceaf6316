#include "host/gpu/shader_source.h"

#include <fstream>
#include <sstream>
#include <string_view>

#include "host/embedded_files.h"
#include "host/error.h"

namespace etendue {

namespace {

std::optional<std::string> read_text(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) return std::nullopt;
    return (std::ostringstream() << file.rdbuf()).str();
}

}  // namespace

uint64_t hash_text(std::string_view text, uint64_t hash) {
    for (unsigned char c : text) hash = (hash ^ c) * 0x100000001b3ull;
    return hash;
}

void ShaderSources::keep_folder() {
    if (!std::filesystem::exists(folder / "registry.h")) return;
    KeptFolder now;
    std::error_code error;
    for (std::filesystem::recursive_directory_iterator i(folder, error), end; !error && i != end;
         i.increment(error)) {
        const auto ending = i->path().extension();
        if (ending != ".glsl" && ending != ".comp" && ending != ".h") continue;
        if (auto text = read_text(i->path()))
            now.files[i->path().lexically_relative(folder).generic_string()] = std::move(*text);
    }
    now.hash = hash_text("");
    for (const auto& [name, text] : now.files) now.hash = hash_text(text, hash_text(name, now.hash));
    kept = std::make_shared<const KeptFolder>(std::move(now));
}

uint64_t ShaderSources::hash() const {
    uint64_t hash = kept ? kept->hash : hash_text("");
    for (const auto& [name, text] : generated) hash = hash_text(text, hash_text(name, hash));
    return hash;
}

std::optional<uint64_t> ShaderSources::whole_hash() const {
    static const uint64_t embedded = [] {
        uint64_t hash = hash_text("");
        for (const EmbeddedFile& file : embedded_shaders())
            hash = hash_text(file.bytes, hash_text(file.name, hash));
        return hash;
    }();
    if (!folder.empty() && !kept) return std::nullopt;
    return hash() ^ embedded;
}

std::optional<std::string> ShaderSources::find(const std::string& name) const {
    if (auto found = generated.find(name); found != generated.end()) return found->second;
    if (kept) {
        if (auto found = kept->files.find(name); found != kept->files.end()) return found->second;
    } else if (!folder.empty()) {
        if (auto text = read_text(folder / name)) return text;
    }
    for (const EmbeddedFile& file : embedded_shaders())
        if (file.name == name) return std::string(file.bytes);
    return std::nullopt;
}

std::string ShaderSources::get(const std::string& name) const {
    if (auto text = find(name)) return *text;
    fail_input("{}: no such shader file", name);
}

}  // namespace etendue
