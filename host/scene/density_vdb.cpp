// OpenVDB's files are read by a module (host/scene/openvdb), which is loaded at the first of them.
#include <dlfcn.h>

#include "host/error.h"
#include "host/scene/density_grid.h"

namespace etendue {

DensityLattice read_vdb(const std::filesystem::path& path, const std::string& grid) {
    // Found by the executable's RUNPATH; never closed, since a lattice reads through its code.
    static void* const module = dlopen("libetendue_openvdb.so", RTLD_NOW | RTLD_LOCAL);
    static const auto read =
        module ? reinterpret_cast<decltype(&etendue_read_vdb)>(dlsym(module, "etendue_read_vdb")) : nullptr;
    if (!read)
        fail_input("{}: there is no libetendue_openvdb.so, which reads OpenVDB files; allowed: NRRD files",
                   path.string());
    DensityLattice lattice;
    read(path, grid, lattice);
    return lattice;
}

}  // namespace etendue
