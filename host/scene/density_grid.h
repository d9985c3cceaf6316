// Densities in space from files: OpenVDB (.vdb) and NRRD, the "nearly raw raster data" that scientific
// programs write (https://teem.sourceforge.net/nrrd/format.html): a few lines of text and the numbers behind
// them.
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <string>

namespace etendue {

// Points of a lattice with a density at each, at least 0 and finite, and zero beyond the outermost ones.
struct DensityLattice {
    glm::uvec3 points{0};                // along each axis, at least 2
    glm::dmat4 world_from_lattice{1.0};  // m; points are whole numbers from 0 on
    // Fills `out`, x fastest, with the densities of `count` points from `first` on; all of them lie in the
    // lattice.
    std::function<void(glm::uvec3 first, glm::uvec3 count, float* out)> read;
};

// By the file's content. `grid`: the name of one of several in an OpenVDB file; empty = "density", or the
// only one. Errors: fail_input with one line that begins with the file's name.
DensityLattice read_density_file(const std::filesystem::path& file, const std::string& grid);

DensityLattice read_vdb(const std::filesystem::path& file, const std::string& grid);  // density_vdb.cpp

}  // namespace etendue

// Of the module that reads .vdb files, where the build has it.
extern "C" void etendue_read_vdb(const std::filesystem::path& file, const std::string& grid,
                                 etendue::DensityLattice& lattice);
