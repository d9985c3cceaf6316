#include "host/preview/start_programs.h"

#include <fstream>
#include <sstream>

#include "host/error.h"
#include "host/gpu/shader_compiler.h"
#include "host/image/atomic_file.h"

namespace etendue {
namespace {

constexpr const char* color_spectra_line = "spectra of colors\n";  // no number: programs end there

// Keys of programs say nothing of the shaders in the binary: those are part of this one.
uint64_t key_of(const ViewOptions& options) {
    std::error_code error;
    uint64_t key = ShaderSources{}.whole_hash().value();
    for (const auto& path : {options.scene, options.environment, options.shaders})
        key = hash_text(path.empty() ? "" : std::filesystem::weakly_canonical(path, error).string(), key);
    return hash_text(fmt::format("{} {} {} {} {} {} {}", options.device, int(options.color),
                                 int(options.polarization), options.spectral_bins, int(options.samples),
                                 int(options.algorithm), int(options.schedule)),
                     key);
}

std::string read_text(const std::filesystem::path& path) {
    std::ifstream file(path);
    return (std::ostringstream() << file.rdbuf()).str();
}

}  // namespace

StartPrograms::StartPrograms(const ViewOptions& options) : folder_(default_cache_folder()) {
    if (!folder_.empty()) file_ = folder_ / fmt::format("view-{:016x}.programs", key_of(options));
}

std::vector<ExpectedProgram> StartPrograms::read() const {
    std::vector<ExpectedProgram> programs;
    std::istringstream lines(read_text(file_));
    uint64_t key = 0;
    std::string name;
    while (lines >> std::hex >> key >> name) programs.push_back({key, folder_ / name});
    return programs;
}

bool StartPrograms::needs_color_spectra() const { return read_text(file_).ends_with(color_spectra_line); }

void StartPrograms::write(const Scene& scene) const {
    std::string text;
    for (const KernelReport& kernel : scene.kernels)
        if (!kernel.spirv.empty())
            text += fmt::format("{:016x} {}\n", kernel.key, kernel.spirv.filename().string());
    if (scene.reads_color_spectra) text += color_spectra_line;
    if (file_.empty() || text == read_text(file_)) return;
    try {
        write_atomically(file_, text);
    } catch (const Error&) {  // a full disk: the next start takes longer
    }
}

}  // namespace etendue
