// Files that travel inside the binary; written by the build (tools/embed_files.cmake).
#pragma once
#include <vector>

namespace etendue {

struct EmbeddedFile {
    const char* name;  // relative to the folder they come from
    const char* text;
};
const std::vector<EmbeddedFile>& embedded_shaders();  // shaders/
const std::vector<EmbeddedFile>& embedded_spectra();  // host/spectra/

}  // namespace etendue
