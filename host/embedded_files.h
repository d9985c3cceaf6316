// Files that travel inside the binary; written by the build (tools/embed_files.cmake).
#pragma once
#include <string_view>
#include <vector>

namespace etendue {

struct EmbeddedFile {
    std::string_view name;  // relative to the folder they come from
    std::string_view bytes;
};
const std::vector<EmbeddedFile>& embedded_shaders();  // shaders/
const std::vector<EmbeddedFile>& embedded_spectra();  // host/spectra/
const std::vector<EmbeddedFile>& embedded_glasses();  // host/lens/
const std::vector<EmbeddedFile>&
embedded_showcases();  // of scenes/, what the examples of classes stand in and name

}  // namespace etendue
