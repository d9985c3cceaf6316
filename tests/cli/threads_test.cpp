// The image does not depend on the number of threads that the device has.
#include "host/image/exr.h"
#include "tests/cli/program.h"

using namespace etendue;

namespace {

// A lamp over a smooth glass ball and a diffuse floor: forward rays, connection and merging.
const char* caustic =
    R"({"asset": {"version": "2.0"}, "extensionsUsed": ["ETD_optics"], "scene": 0, "scenes": [{"nodes": [0, 1, 2, 3]}],
"nodes": [{"extensions": {"ETD_optics": {"geometry": {"class": "sphere", "radius": 0.5, "material": 0}}}, "translation": [0, 0, 0.8]},
          {"extensions": {"ETD_optics": {"geometry": {"class": "rectangle", "size": [4, 4], "material": 1}}}},
          {"extensions": {"ETD_optics": {"geometry": {"class": "sphere", "radius": 0.1, "material": 2}}}, "translation": [0.4, 0, 3]},
          {"camera": 0, "translation": [0, 0, 5]}],
"materials": [{"extensions": {"ETD_optics": {"surface": {"class": "dielectric", "ior": 1.5}}}},
              {"extensions": {"ETD_optics": {"surface": {"class": "lambertian"}}}},
              {"extensions": {"ETD_optics": {"surface": {"class": "absorber"}, "emission": {"radiance": [90, 80, 70]}}}}],
"cameras": [{"type": "perspective", "perspective": {"yfov": 0.6, "znear": 0.1}}]})";

}  // namespace

TEST_CASE("one, two and four threads give the same image of both directions, bit for bit") {
    Executable program;
    write_text(program.folder / "s.gltf", caustic);
    const auto image = [&](const std::string& threads, const std::string& seed) {
        program.environment["LP_NUM_THREADS"] = threads;
        const Run run = program.run({"render", "s.gltf", "-o", "out.exr", "--size", "96x80", "--passes", "6",
                                     "--algorithm", "bidirectional", "--seed", seed, "-q"});
        CAPTURE(run.err);
        REQUIRE(run.code == 0);
        return read_exr(program.folder / "out.exr").values;
    };
    const std::vector<float> one = image("1", "7");
    CHECK(image("2", "7") == one);
    CHECK(image("4", "7") == one);
    CHECK(image("2", "8") != one);
}
