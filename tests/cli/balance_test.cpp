// Where the light went, by material and by meter: what measure and render --stats tell of it.
#include <nlohmann/json.hpp>

#include "tests/cli/program.h"

using namespace etendue;

namespace {

// A lamp over a floor that a meter lies on, half of whose light goes up and away.
const char* scene_text = R"({"asset": {"version": "2.0"}, "extensionsUsed": ["ETD_optics"], "scene": 0,
    "materials": [{"name": "grey", "extensions": {"ETD_optics": {"surface": {"class": "lambertian", "reflectance": 0.25}}}}],
    "scenes": [{"nodes": [0, 1, 2]}], "nodes": [
    {"name": "lamp", "translation": [0, 0, 1], "extensions": {"ETD_optics": {"light": {"class": "point", "intensity": 100}}}},
    {"name": "ground", "extensions": {"ETD_optics": {"geometry": {"class": "disk", "radius": 100, "material": 0}}}},
    {"name": "plane", "extensions": {"ETD_optics": {"receiver": {"class": "illuminance", "size": [2, 2], "resolution": [4, 4]}}}}]})";

double line_of(const std::string& text, const std::string& start) {
    const size_t at = text.find("\n" + start);
    REQUIRE_MESSAGE(at != std::string::npos, start);
    return std::stod(text.substr(at + 1 + start.size()));
}

}  // namespace

TEST_CASE("reports and statistics tell what each material absorbed and each meter received") {
    Executable program;
    write_text(program.folder / "s.gltf", scene_text);
    const auto measure = [&](std::vector<std::string> more) {
        more.insert(more.begin(),
                    {"measure", "s.gltf", "-q", "--algorithm", "forward", "--forward-paths", "256"});
        const Run run = program.run(more);
        CAPTURE(run.err);
        REQUIRE(run.code == 0);
    };
    measure({"-o", "one", "--passes", "64"});
    const std::string balance = read_text(program.folder / "one/balance.csv");
    const double emitted = line_of(balance, "emitted,"), absorbed = line_of(balance, "absorbed,"),
                 grey = line_of(balance, "absorbed by material grey,"),
                 received = line_of(balance, "received by plane,");
    CHECK(emitted == doctest::Approx(400 * 3.14159265).epsilon(1e-5));
    CHECK(grey == doctest::Approx(absorbed).epsilon(1e-6));
    CHECK(grey ==
          doctest::Approx(0.75 * emitted / 2).epsilon(0.02));  // the disk is seen nearly as a half space
    CHECK(emitted - grey - line_of(balance, "escaped,") - line_of(balance, "lost,") -
              line_of(balance, "roulette,") ==
          doctest::Approx(0).epsilon(2e-6 * emitted));
    CHECK(received ==
          doctest::Approx(100 * 4 * 3.14159265 / 6).epsilon(0.02));  // the lower face of a cube of 2 m
    CHECK(read_text(program.folder / "one/index.html").find("absorbed by material grey") !=
          std::string::npos);
    measure({"--passes", "0:16", "--checkpoint", "a.etd"});
    measure({"--passes", "16:64", "--checkpoint", "b.etd"});
    REQUIRE(program.run({"merge", "b.etd", "a.etd", "-o", "merged", "-q"}).code == 0);
    CHECK(line_of(read_text(program.folder / "merged/balance.csv"), "absorbed by material grey,") ==
          doctest::Approx(grey).epsilon(1e-8));

    REQUIRE(program
                .run({"render", "s.gltf", "-o", "x.exr", "-q", "--algorithm", "forward", "--forward-paths",
                      "256", "--passes", "64", "--stats", "stats.json"})
                .code == 0);
    const auto stats = nlohmann::json::parse(read_text(program.folder / "stats.json"));
    const auto& power = stats.at("power_balance");
    CHECK(power.at("absorbed_by").at("material grey").get<double>() ==
          doctest::Approx(power.at("absorbed").get<double>()).epsilon(1e-6));
    CHECK(stats.at("received_by").at("plane").get<double>() == doctest::Approx(received).epsilon(0.01));
}
