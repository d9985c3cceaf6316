// Which programs, and whether spectra of colours, a window on a scene needed for its first picture: noted in
// the folder of compiled kernels, so that the next start has them made while it still reads the scene.
#pragma once
#include <vector>

#include "host/options.h"
#include "host/gpu/program_store.h"
#include "host/scene/scene.h"

namespace etendue {

class StartPrograms {
  public:
    explicit StartPrograms(const ViewOptions& options);
    std::vector<ExpectedProgram> read() const;  // those of the last start; none where there was none
    bool needs_color_spectra() const;           // host/spectra/color.h
    void write(const Scene& scene) const;

  private:
    std::filesystem::path folder_, file_;
};

}  // namespace etendue
