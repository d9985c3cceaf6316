// The module that reads .vdb files: libetendue_openvdb.so, which host/scene/density_vdb.cpp loads where a
// scene has any. OpenVDB takes 30 ms to load, whatever for, and its headers ten seconds to compile.
#include "host/error.h"
#include "host/scene/density_grid.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wall"
#pragma GCC diagnostic ignored "-Wextra"
#include <openvdb/openvdb.h>
#include <openvdb/tools/Dense.h>
#pragma GCC diagnostic pop

namespace etendue {
namespace {

openvdb::FloatGrid::Ptr find_grid(openvdb::io::File& file, const std::string& wanted,
                                  const std::string& where) {
    std::vector<std::string> names;
    for (auto i = file.beginName(); i != file.endName(); ++i) names.push_back(i.gridName());
    std::string name = wanted.empty() ? "density" : wanted;
    if (wanted.empty() && names.size() == 1) name = names.front();
    if (std::find(names.begin(), names.end(), name) == names.end())
        fail_input("{}: the OpenVDB file has no grid '{}'; it has: {}", where, name, fmt::join(names, ", "));
    const auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid(name));
    if (!grid) fail_input("{}: the grid '{}' holds no floats; allowed: a grid of floats", where, name);
    if (grid->getGridClass() == openvdb::GRID_LEVEL_SET)
        fail_input("{}: the grid '{}' is a level set; allowed: a fog volume", where, name);
    if (!grid->transform().isLinear())
        fail_input("{}: the grid '{}' has a perspective transform; allowed: an affine one", where, name);
    if (grid->background() != 0)
        fail_input("{}: the grid '{}' has the density {} outside; allowed: 0", where, name,
                   grid->background());
    return grid;
}

DensityLattice read_lattice(const std::filesystem::path& path, const std::string& name) {
    const std::string where = path.string();
    try {
        openvdb::initialize();
        openvdb::io::File file(where);
        file.open(false);
        const openvdb::FloatGrid::Ptr grid = find_grid(file, name, where);
        const openvdb::CoordBBox active = grid->evalActiveVoxelBoundingBox();
        if (active.empty()) fail_input("{}: the grid '{}' is empty", where, grid->getName());
        DensityLattice lattice;
        // One point more on every side, where the density is zero.
        const openvdb::Coord first = active.min().offsetBy(-1), dim = active.dim().offsetBy(2);
        const openvdb::Mat4R m = grid->transform().baseMap()->getAffineMap()->getMat4();  // of row vectors
        for (int c = 0; c < 3; ++c) {
            if (dim[c] > 65536)
                fail_input("{}: the grid '{}' has {} voxels along an axis", where, name, dim[c]);
            lattice.points[c] = uint32_t(dim[c]);
        }
        for (int row = 0; row < 4; ++row)
            for (int c = 0; c < 4; ++c) lattice.world_from_lattice[row][c] = m(row, c);
        lattice.world_from_lattice[3] =
            lattice.world_from_lattice * glm::dvec4(first.x(), first.y(), first.z(), 1);
        lattice.read = [grid, first](glm::uvec3 from, glm::uvec3 count, float* out) {
            const openvdb::Coord lo = first.offsetBy(int(from.x), int(from.y), int(from.z));
            const openvdb::CoordBBox box(lo,
                                         lo.offsetBy(int(count.x) - 1, int(count.y) - 1, int(count.z) - 1));
            openvdb::tools::Dense<float, openvdb::tools::LayoutXYZ> dense(box, out);
            openvdb::tools::copyToDense(*grid, dense, true);
        };
        return lattice;
    } catch (const Error&) {
        throw;
    } catch (const std::exception& e) {
        fail_input("{}: the OpenVDB file cannot be read: {}", where, e.what());
    }
}

}  // namespace
}  // namespace etendue

extern "C" void etendue_read_vdb(const std::filesystem::path& file, const std::string& grid,
                                 etendue::DensityLattice& lattice) {
    lattice = etendue::read_lattice(file, grid);
}
