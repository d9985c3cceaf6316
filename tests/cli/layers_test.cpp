// Layers of light as users ask for them: from the scene and by --layers, in images, reports, checkpoints and
// parts.
#include <nlohmann/json.hpp>

#include "host/image/exr.h"
#include "tests/cli/program.h"

using namespace etendue;

namespace {

// Two lamps over a floor, which a camera sees and a meter lies on; the scene asks for a layer of one of them.
const char* scene_text = R"({"asset": {"version": "2.0"}, "extensionsUsed": ["ETD_optics"], "scene": 0,
    "extensions": {"ETD_optics": {"layers": [{"name": "left", "events": ["emitted"], "objects": ["left"]}]}},
    "materials": [{"name": "floor", "extensions": {"ETD_optics": {"surface": {"class": "lambertian", "reflectance": 0.5}}}}],
    "cameras": [{"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 1, "znear": 0, "zfar": 10}}],
    "scenes": [{"nodes": [0, 1, 2, 3, 4]}], "nodes": [
    {"name": "left", "translation": [-0.5, 0, 2], "extensions": {"ETD_optics": {"light": {"class": "point", "intensity": 1}}}},
    {"name": "right", "translation": [0.5, 0, 2], "extensions": {"ETD_optics": {"light": {"class": "point", "intensity": 3}}}},
    {"name": "ground", "extensions": {"ETD_optics": {"geometry": {"class": "rectangle", "size": [2, 2], "material": 0}}}},
    {"name": "camera", "camera": 0, "translation": [0, 0, 3]},
    {"name": "plane", "extensions": {"ETD_optics": {"receiver": {"class": "illuminance", "size": [2, 2], "resolution": [4, 4]}}}}]})";

struct Setup {
    Executable program;
    Setup() { write_text(program.folder / "s.gltf", scene_text); }
    void run(std::vector<std::string> words, const std::vector<std::string>& more = {}) const {
        words.insert(words.end(), more.begin(), more.end());
        const Run run = program.run(words);
        CAPTURE(run.err);
        REQUIRE(run.code == 0);
    }
    Image image(const char* name) const { return read_exr(program.folder / name); }
};

double mean_of(const Image& image, const std::string& channel) {
    const int at = find_channel(image, channel);
    REQUIRE_MESSAGE(at >= 0, channel);
    double sum = 0;
    for (const float x : plane(image, size_t(at))) sum += x;
    return sum / double(pixel_count(image));
}

std::string line_of(const std::string& text, const std::string& start) {
    const size_t at = text.find("\n" + start);
    REQUIRE_MESSAGE(at != std::string::npos, start);
    return text.substr(at + 1 + start.size(), text.find('\n', at + 1) - at - 1 - start.size());
}

const std::vector<std::string> render = {"render", "s.gltf",      "-q",           "--size",
                                         "8x8",    "--algorithm", "bidirectional"};

}  // namespace

TEST_CASE("images have the layers of the scene, or those that are asked for") {
    const Setup s;
    s.run(render, {"-o", "scene.exr", "--passes", "8", "--aovs"});
    const Image scene = s.image("scene.exr");
    CHECK(mean_of(scene, "left.G") + mean_of(scene, "rest.G") ==
          doctest::Approx(mean_of(scene, "G")).epsilon(1e-6));
    CHECK(mean_of(scene, "rest.G") == doctest::Approx(3 * mean_of(scene, "left.G")).epsilon(0.01));
    CHECK(find_channel(scene, "error.rest.B") >= 0);
    s.run(render, {"-o", "lamps.exr", "--passes", "8", "--layers", "lamps"});
    const Image lamps = s.image("lamps.exr");
    CHECK(mean_of(lamps, "right.G") == mean_of(scene, "rest.G"));
    CHECK(find_channel(lamps, "rest.R") < 0);
    s.run(render, {"-o", "none.exr", "--passes", "8", "--layers", "none"});
    CHECK(s.image("none.exr").channels == std::vector<std::string>{"B", "G", "R"});
    write_text(s.program.folder / "l.json", R"([{"name": "all", "events": ["reflected"], "times": 1}])");
    s.run(render, {"-o", "file.exr", "--passes", "8", "--layers", "l.json"});
    CHECK(mean_of(s.image("file.exr"), "all.R") == mean_of(s.image("none.exr"), "R"));
    CHECK(s.program.run({"compare", "file.exr", "none.exr", "--max-relmse", "1e-12"}).code == 0);
}

TEST_CASE("layers are kept in checkpoints, and parts merge with them") {
    const Setup s;
    s.run(render, {"-o", "single.exr", "--passes", "16", "--aovs"});
    s.run(render, {"-o", "a.exr", "--passes", "0:6", "--checkpoint", "a.etd"});
    s.run(render, {"-o", "b.exr", "--passes", "6:16", "--checkpoint", "b.etd"});
    s.run({"merge", "b.etd", "a.etd", "-o", "merged.exr", "--aovs", "-q"});
    for (const char* channel : {"R", "left.R", "rest.G", "error.left.B"})
        CHECK(mean_of(s.image("merged.exr"), channel) == mean_of(s.image("single.exr"), channel));
    s.run(render, {"-o", "resumed.exr", "--passes", "16", "--resume", "a.etd"});
    CHECK(mean_of(s.image("resumed.exr"), "left.R") == mean_of(s.image("single.exr"), "left.R"));
    std::vector<std::string> other = render;
    other.insert(other.end(), {"-o", "x.exr", "--passes", "16", "--resume", "a.etd", "--layers", "none"});
    const Run refused = s.program.run(other);
    CHECK(refused.code == 2);
    CHECK(refused.err.find("layer") != std::string::npos);
}

TEST_CASE("meters tell mean, flux and share of each layer, in parts as in one") {
    const Setup s;
    const std::vector<std::string> measure = {"measure", "s.gltf", "-q", "--layers", "lamps"};
    s.run(measure, {"-o", "one", "--passes", "64"});
    const std::string figures = read_text(s.program.folder / "one/figures.csv");
    const double flux = std::stod(line_of(figures, "plane,flux,lm,"));
    const double left = std::stod(line_of(figures, "plane,flux of left,lm,")),
                 right = std::stod(line_of(figures, "plane,flux of right,lm,"));
    CHECK(left + right == doctest::Approx(flux).epsilon(1e-6));
    CHECK(std::stod(line_of(figures, "plane,share of right,,")) == doctest::Approx(0.75).epsilon(0.01));
    CHECK(std::stod(line_of(figures, "plane,mean of left,lx,")) == doctest::Approx(left / 4).epsilon(1e-6));
    CHECK(read_text(s.program.folder / "one/index.html").find("share of left") != std::string::npos);
    CHECK(mean_of(s.image("one/plane.exr"), "left.G") * 4 == doctest::Approx(left).epsilon(1e-5));
    CHECK(find_channel(s.image("one/plane.exr"), "error.left.G") >= 0);
    s.run(measure, {"--passes", "0:16", "--checkpoint", "a.etd"});
    s.run(measure, {"--passes", "16:64", "--checkpoint", "b.etd"});
    s.run({"merge", "b.etd", "a.etd", "-o", "merged", "-q"});
    CHECK(read_text(s.program.folder / "merged/figures.csv") == figures);
}

TEST_CASE("layers that cannot be are told in one line") {
    const Setup s;
    const std::vector<std::pair<std::string, std::string>> bad = {
        {"lamp", "lamp"},
        {"[{]", "is no JSON"},
        {R"([{"name": "a"}])", "/0: says nothing of its light"},
        {R"([{"name": "rest", "times": 1}])", "/0/name: is 'rest'"},
        {R"([{"name": "a", "times": 1}, {"name": "a", "times": 2}])", "/1/name: is 'a'"},
        {R"([{"name": "a", "events": ["absorbed"]}])", "/0/events: has 'absorbed'; allowed: emitted"},
        {R"([{"name": "a", "objects": ["mirror"]}])",
         "the scene has no lamp, node, material or medium 'mirror'; it has"},
        {R"([{"name": "a", "least": 3, "most": 2}])", "at least 3 events and at most 2"},
        {R"([{"name": "a", "times": 16}, {"name": "b", "events": ["reflected"], "times": 16}])", "32 bits"}};
    for (const auto& [layers, said] : bad) {
        std::vector<std::string> words = render;
        words.insert(words.end(), {"-o", "x.exr", "--passes", "1", "--layers", layers});
        const Run run = s.program.run(words);
        CAPTURE(layers);
        CAPTURE(run.err);
        CHECK(run.code == 2);
        CHECK(run.error_lines() == 1);
        CHECK(run.err.find(said) != std::string::npos);
    }
}
