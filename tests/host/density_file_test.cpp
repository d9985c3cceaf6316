// Files with densities in space: what is read of them, and what is said of bad ones.
#include <doctest/doctest.h>

#include <functional>

#include "host/error.h"
#include "host/scene/density_bricks.h"
#include "tests/support/density_field.h"
#include "tests/support/temporary_folder.h"
#if ETENDUE_OPENVDB
#include <openvdb/openvdb.h>
#endif

using namespace etendue;

namespace {

std::string message_of(const std::filesystem::path& file, const std::string& grid = "") {
    try {
        DensityBricks bricks;
        add_bricks(bricks, read_density_file(file, grid), file.filename().string());
    } catch (const Error& e) {
        CHECK(e.code == ExitCode::bad_input);
        return e.what();
    }
    return "no message";
}

const std::string header =
    "NRRD0004\n# made by a test\ntype: uchar\ndimension: 3\nsizes: 3 2 2\nencoding: raw\nspacings: 0.5 1 2\n";

struct Fault {
    const char *what, *by, *message;
};

std::string replaced(std::string text, const std::string& what, const std::string& by) {
    const size_t at = text.find(what);
    REQUIRE(at != std::string::npos);
    return text.replace(at, what.size(), by);
}

}  // namespace

TEST_CASE("NRRD files of bytes and floats are read, with their placement") {
    TemporaryFolder folder;
    write_text(folder / "bytes.nrrd",
               header + "key:=value\nspace origin: (1,2,3)\n\n" +
                   std::string("\x00\x01\x02\x03\x04\x05\x06\x07\x08\x09\x0A\xFF", 12));
    const DensityLattice bytes = read_density_file(folder / "bytes.nrrd", "");
    CHECK(bytes.points == glm::uvec3(3, 2, 2));
    CHECK(bytes.world_from_lattice * glm::dvec4(2, 1, 1, 1) == glm::dvec4(2, 3, 5, 1));
    float values[4];
    bytes.read({1, 0, 0}, {2, 2, 1}, values);
    CHECK(values[0] == 1);
    CHECK(values[1] == 2);
    CHECK(values[3] == 5);
    bytes.read({2, 1, 1}, {1, 1, 1}, values);
    CHECK(values[0] == 255);

    const DensityField field({5, 4, 3}, {-1, 0, 2}, {1, 3, 4},
                             [](glm::dvec3 p) { return 3 + p.x + p.y * p.z; });
    field.write(folder / "floats.nrrd");
    const DensityLattice floats = read_density_file(folder / "floats.nrrd", "");
    float all[60];
    floats.read({0, 0, 0}, {5, 4, 3}, all);
    for (int i = 0; i < 60; ++i) CHECK(all[i] == field.values[size_t(i)]);
    CHECK(floats.world_from_lattice * glm::dvec4(4, 3, 2, 1) == glm::dvec4(1, 3, 4, 1));
}

TEST_CASE("bricks know the least, the greatest and the mean density, and keep values only where it varies") {
    TemporaryFolder folder;
    // Zero below x = 4, then 2 x - 8; the lattice ends within the third brick along x and a second along y.
    DensityField({11, 6, 3}, {0, 0, 0}, {10, 5, 2}, [](glm::dvec3 p) {
        return std::max(0.0, 2 * p.x - 8);
    }).write(folder / "ramp.nrrd");
    DensityBricks bricks;
    const DensityGridRecord grid =
        add_bricks(bricks, read_density_file(folder / "ramp.nrrd", ""), "ramp.nrrd");
    CHECK(grid.cells == glm::uvec3(10, 5, 2));
    REQUIRE(bricks.bricks.size() == 6);
    const float least[] = {0, 0, 8}, greatest[] = {0, 8, 12}, mean[] = {0, 4, 10};
    for (int i = 0; i < 6; ++i) {
        CHECK(bricks.bricks[size_t(i)].least == least[i % 3]);
        CHECK(bricks.bricks[size_t(i)].greatest == greatest[i % 3]);
        CHECK(bricks.bricks[size_t(i)].mean == doctest::Approx(mean[i % 3]));
        CHECK((bricks.bricks[size_t(i)].first_value == 0xFFFFFFFFu) == (i % 3 == 0));
    }
    CHECK(bricks.values.size() == 4 * 125);
    CHECK(bricks.values[125 + 1] == 10);
}

TEST_CASE("bad NRRD files are told in one line") {
    TemporaryFolder folder;
    const std::string data(12, '\1');
    const Fault faults[] = {
        {"NRRD0004", "PNG", "neither an OpenVDB nor an NRRD file"},
        {"type: uchar", "type: double", "'type: double'; allowed: float, uchar"},
        {"type: uchar\n", "", "'type: none'"},
        {"type: uchar", "type: float", "'endian: none'; allowed: little"},
        {"dimension: 3", "dimension: 4", "'dimension: 4'; allowed: 3"},
        {"sizes: 3 2 2", "sizes: 3 2", "'sizes: 3 2' of the NRRD file is not three numbers"},
        {"sizes: 3 2 2", "sizes: 12 1 1", "the size 1 along an axis"},
        {"sizes: 3 2 2", "sizes: 3 2 2.5", "the size 2.5 along an axis"},
        {"sizes: 3 2 2", "sizes: 3 2 1e9", "the size 1000000000 along an axis"},
        {"sizes: 3 2 2", "sizes: 3 2 3", "12 bytes follow the header of the NRRD file; 3 x 2 x 3 values"},
        {"encoding: raw", "encoding: gzip", "'encoding: gzip'; allowed: raw"},
        {"spacings: 0.5 1 2", "spacings: 0.5 x 2", "'spacings: 0.5 x 2'"},
        {"spacings: 0.5 1 2", "data file: x.raw", "lie in another file"},
    };
    for (const Fault& fault : faults) {
        write_text(folder / "bad.nrrd", replaced(header + "\n" + data, fault.what, fault.by));
        const std::string message = message_of(folder / "bad.nrrd");
        CAPTURE(message);
        CHECK(message.find("bad.nrrd: ") != std::string::npos);
        CHECK(message.find(fault.message) != std::string::npos);
        CHECK(message.find('\n') == std::string::npos);
    }
    write_text(folder / "bad.nrrd", header);
    CHECK(message_of(folder / "bad.nrrd").find("has no end") != std::string::npos);
    write_text(folder / "good.nrrd", header + "\n" + data);
    CHECK(message_of(folder / "good.nrrd") == "no message");
    CHECK(message_of(folder / "good.nrrd", "smoke").find("no grid of the name 'smoke'") != std::string::npos);
    CHECK(message_of(folder / "none.nrrd").find("none.nrrd") != std::string::npos);
    DensityField({3, 2, 2}, {0, 0, 0}, {1, 1, 1}, [](glm::dvec3 p) {
        return p.x - 0.5;
    }).write(folder / "bad.nrrd");
    CHECK(message_of(folder / "bad.nrrd").find("is -0.5 at one; allowed: finite numbers, at least 0") !=
          std::string::npos);
    DensityField({3, 2, 2}, {0, 0, 0}, {1, 1, 1}, [](glm::dvec3 p) {
        return 1 / p.x;
    }).write(folder / "bad.nrrd");
    CHECK(message_of(folder / "bad.nrrd").find("is inf at one") != std::string::npos);
}

#if ETENDUE_OPENVDB
TEST_CASE("OpenVDB files are read with their own placement, bad ones told in one line") {
    TemporaryFolder folder;
    openvdb::initialize();
    const auto write = [&](const char* name, openvdb::GridPtrVec grids) {
        openvdb::io::File(folder / name).write(grids);
    };
    const auto cloud = openvdb::FloatGrid::create(0);
    cloud->setName("smoke");
    cloud->setTransform(openvdb::math::Transform::createLinearTransform(0.25));
    cloud->transform().postTranslate({1, 2, 3});
    for (int x = -20; x <= 5; ++x) cloud->getAccessor().setValue({x, 3 * x, 7}, float(x + 30));
    write("cloud.vdb", {cloud});

    const DensityLattice lattice = read_density_file(folder / "cloud.vdb", "");
    CHECK(lattice.points == glm::uvec3(28, 78, 3));
    // The lattice's first point is the voxel (-21, -61, 6).
    CHECK(lattice.world_from_lattice * glm::dvec4(0, 0, 0, 1) == glm::dvec4(1 - 5.25, 2 - 15.25, 3 + 1.5, 1));
    CHECK(lattice.world_from_lattice * glm::dvec4(1, 2, 3, 0) == glm::dvec4(0.25, 0.5, 0.75, 0));
    std::vector<float> values(28 * 78 * 3);
    lattice.read({0, 0, 0}, lattice.points, values.data());
    for (uint32_t i = 0; i < values.size(); ++i) {
        const int x = int(i % 28) - 21, y = int(i / 28 % 78) - 61, z = int(i / (28 * 78)) + 6;
        const bool set = z == 7 && y == 3 * x && x >= -20 && x <= 5;
        REQUIRE(values[i] == (set ? float(x + 30) : 0.0f));
    }
    float one;
    lattice.read({21, 61, 1}, {1, 1, 1}, &one);
    CHECK(one == 30);

    CHECK(message_of(folder / "cloud.vdb", "smoke") == "no message");
    CHECK(message_of(folder / "cloud.vdb", "fire").find("has no grid 'fire'; it has: smoke") !=
          std::string::npos);
    const auto vectors = openvdb::Vec3SGrid::create();
    vectors->setName("density");
    const auto empty = openvdb::FloatGrid::create(0);
    empty->setName("empty");
    const auto full = openvdb::FloatGrid::create(2);
    full->setName("full");
    const auto level = openvdb::FloatGrid::create(0);
    level->setName("level"), level->setGridClass(openvdb::GRID_LEVEL_SET);
    write("odd.vdb", {vectors, empty, full, level});
    CHECK(message_of(folder / "odd.vdb").find("'density' holds no floats") != std::string::npos);
    CHECK(message_of(folder / "odd.vdb", "empty").find("'empty' is empty") != std::string::npos);
    CHECK(message_of(folder / "odd.vdb", "full").find("the density 2 outside; allowed: 0") !=
          std::string::npos);
    CHECK(message_of(folder / "odd.vdb", "level").find("a level set; allowed: a fog volume") !=
          std::string::npos);
    for (const size_t part : {20u, 300u, 2000u}) {
        write_text(folder / "cut.vdb", read_text(folder / "cloud.vdb").substr(0, part));
        const std::string message = message_of(folder / "cut.vdb");
        CAPTURE(message);
        CHECK(message.find("cut.vdb") != std::string::npos);
        CHECK(message.find('\n') == std::string::npos);
    }
}
#endif
