// etendue measure as its users run it: reports, ranges and merging, bad words.
#include <filesystem>

#include "host/image/exr.h"
#include "host/photometry/intensity_distribution.h"
#include "host/photometry/ray_file.h"
#include "host/render/spectral_film.h"
#include "host/spectra/color.h"
#include "host/spectra/library.h"
#include "tests/cli/program.h"

using namespace etendue;

namespace {

// A point of 1000 cd 2 m above a plane of 2 x 2 m, a goniophotometer, and a meter that faces away.
const char* scene_text = R"({"asset": {"version": "2.0"}, "extensionsUsed": ["ETD_optics"], "scene": 0,
    "scenes": [{"nodes": [0, 1, 2, 3]}], "nodes": [
    {"name": "lamp", "translation": [0, 2, 0], "extensions": {"ETD_optics": {"light": {"class": "point", "intensity": 1000}}}},
    {"name": "plane", "rotation": [-0.70710678, 0, 0, 0.70710678], "extensions": {"ETD_optics": {"receiver":
        {"class": "illuminance", "size": [2, 2], "resolution": [8, 8]}}}},
    {"name": "gonio", "rotation": [0.70710678, 0, 0, 0.70710678], "extensions": {"ETD_optics": {"receiver":
        {"class": "intensity", "resolution": [8, 7]}}}},
    {"name": "away", "translation": [0, 3, 0], "rotation": [-0.70710678, 0, 0, 0.70710678], "extensions": {"ETD_optics":
        {"receiver": {"class": "illuminance", "size": [1, 1], "resolution": [2, 2]}}}}]})";

std::string text_of(const Executable& program, const std::string& file) {
    return read_text(program.folder / file);
}

std::vector<float> plane_of(const Image& image) {
    const auto green = plane(image, size_t(find_channel(image, "G")));
    return {green.begin(), green.end()};
}

}  // namespace

TEST_CASE("a report has the figures, images, tables and a page of every meter") {
    Executable program;
    write_text(program.folder / "s.gltf", scene_text);
    const Run run = program.run({"measure", "s.gltf", "-o", "out", "--passes", "64", "--points", "9"});
    CAPTURE(run.err);
    REQUIRE(run.code == 0);
    CHECK(run.out.find("min / max of 9 points") != std::string::npos);
    for (const char* file : {"index.html", "figures.csv", "plane.exr", "plane.csv", "plane.map.png",
                             "plane.sections.svg", "gonio.exr", "gonio.polar.svg", "away.csv"}) {
        CAPTURE(file);
        CHECK(std::filesystem::exists(program.folder / "out" / file));
    }
    const std::string page = text_of(program, "out/index.html");
    CHECK(page.find("data:image/png;base64,") != std::string::npos);
    CHECK(page.find("no light has arrived: with 95 % confidence its flux is below 0.036 lm") !=
          std::string::npos);
    const Image image = read_exr(program.folder / "out/plane.exr");
    CHECK(std::get<std::string>(image.attributes.at("pixelUnit")) == "lx");
    CHECK(find_channel(image, "error.R") >= 0);
    for (const char* file : {"out/gonio.ies", "out/gonio.ldt"}) {
        CAPTURE(file);
        const IntensityDistribution d = read_photometric_file(program.folder / file);
        CHECK(d.flux() == doctest::Approx(4000 * 3.14159265).epsilon(0.05));
        CHECK(d.intensity(100, 90) == doctest::Approx(1000).epsilon(0.1));
    }
    // A later run may take the folder; other folders are let alone.
    CHECK(program.run({"measure", "s.gltf", "-o", "out", "--passes", "16", "-q"}).code == 0);
    std::filesystem::create_directory(program.folder / "mine");
    write_text(program.folder / "mine/letter.txt", "dear");
    const Run refused = program.run({"measure", "s.gltf", "-o", "mine", "--passes", "16"});
    CHECK(refused.code == 2);
    CHECK(refused.err.find("holds other files") != std::string::npos);
}

TEST_CASE("with spectral bins, meters tell spectra and colour rendering, in parts as in one") {
    Executable program;
    std::string scene = scene_text;
    const std::string lamp = R"("intensity": 1000)";
    scene.replace(scene.find(lamp), lamp.size(), R"("intensity": 1000, "color": {"illuminant": "F2"})");
    write_text(program.folder / "s.gltf", scene);
    const auto measure = [&](std::vector<std::string> more) {
        more.insert(more.begin(), {"measure", "s.gltf", "-q", "--receivers", "plane,away"});
        return program.run(more);
    };
    const Run run = measure({"--passes", "512", "-o", "out", "--spectral-bins", "94"});
    CAPTURE(run.err);
    REQUIRE(run.code == 0);
    const std::string figures = text_of(program, "out/figures.csv");
    const size_t at = figures.find("\nplane,Ra,,");
    REQUIRE(at != std::string::npos);
    CHECK(std::stod(figures.substr(at + 11)) == doctest::Approx(64).epsilon(0.02));
    CHECK(figures.find("\nplane,R14,,") != std::string::npos);
    CHECK(text_of(program, "out/index.html").find("<td>Ra</td>") != std::string::npos);
    const Image image = read_exr(program.folder / "out/plane.exr");
    CHECK(std::get<std::string>(image.attributes.at("emissiveUnits")) == "W.m^-2.nm^-1");
    REQUIRE(find_channel(image, "S0.362,500000nm") >= 0);
    // The spectrum of a pixel is worth its lux, by the observer at the bins' middles.
    double lux = 0;
    const SpectralTable y = library_table("CIE 1931 y", Outside::zero);
    for (uint32_t bin = 0; bin < 94; ++bin)
        lux += 683 * 5 * y.at(362.5 + 5 * bin) *
               plane(image, size_t(find_channel(image, spectral_channel(bin, 94))))[27];
    const auto channel = [&](const char* name) {
        return double(plane(image, size_t(find_channel(image, name)))[27]);
    };
    CHECK(lux == doctest::Approx(luminance({channel("R"), channel("G"), channel("B")})).epsilon(0.03));

    CHECK(measure({"--passes", "256:512", "--checkpoint", "b.etd", "--spectral-bins", "94"}).code == 0);
    CHECK(measure({"--passes", "0:256", "--checkpoint", "a.etd", "--spectral-bins", "94"}).code == 0);
    REQUIRE(program.run({"merge", "b.etd", "a.etd", "-o", "merged"}).code == 0);
    CHECK(text_of(program, "merged/figures.csv") == figures);
    CHECK(measure({"--passes", "16", "-o", "x", "--spectral-bins", "9", "--color", "rgb"})
              .err.find("--color spectral or auto") != std::string::npos);
}

TEST_CASE(
    "parts of a measurement merge to the single run, and a resumed one goes on as if it had never ended") {
    Executable program;
    write_text(program.folder / "s.gltf", scene_text);
    const auto measure = [&](std::vector<std::string> more) {
        more.insert(more.begin(), {"measure", "s.gltf", "-q"});
        const Run run = program.run(more);
        CAPTURE(run.err);
        REQUIRE(run.code == 0);
    };
    measure({"--passes", "96", "-o", "single", "--points", "5"});
    for (const char* range : {"64:96", "0:32", "32:64"})
        measure(
            {"--passes", range, "--checkpoint", std::string(range).substr(0, 1) + ".etd", "--points", "5"});
    const Run merged =
        program.run({"merge", "6.etd", "0.etd", "3.etd", "-o", "merged", "--stats", "stats.json"});
    CAPTURE(merged.err);
    REQUIRE(merged.code == 0);
    for (const char* file : {"figures.csv", "plane.csv", "gonio.csv"})
        CHECK(text_of(program, std::string("merged/") + file) ==
              text_of(program, std::string("single/") + file));
    CHECK(text_of(program, "stats.json").find("relative_error_bound") != std::string::npos);

    measure({"--passes", "32", "--checkpoint", "begun.etd"});
    measure({"--passes", "96", "--resume", "begun.etd", "-o", "resumed", "--points", "5"});
    CHECK(text_of(program, "resumed/figures.csv") == text_of(program, "single/figures.csv"));

    const Run twice = program.run({"merge", "0.etd", "begun.etd", "-o", "twice"});
    CHECK(twice.code == 2);
    CHECK(twice.err.find("has passes 0:32") != std::string::npos);
    measure({"--passes", "96:112", "--seed", "1", "--checkpoint", "other.etd"});
    CHECK(program.run({"merge", "0.etd", "other.etd", "-o", "twice"}).err.find("seed") != std::string::npos);
    CHECK(!std::filesystem::exists(program.folder / "twice"));
}

TEST_CASE("what cannot be measured is said in one line") {
    Executable program;
    write_text(program.folder / "s.gltf", scene_text);
    write_text(program.folder / "camera.gltf", small_scene());
    const auto refusal = [&](std::vector<std::string> words) {
        words.insert(words.begin(), "measure");
        const Run run = program.run(words);
        CHECK(run.code == 2);
        CHECK(std::count(run.err.begin(), run.err.end(), '\n') == 1);
        return run.err;
    };
    CHECK(refusal({"camera.gltf", "-o", "out"}).find("no receiver that measures") != std::string::npos);
    CHECK(refusal({"s.gltf"}).find("--output or --checkpoint") != std::string::npos);
    CHECK(refusal({"s.gltf", "-o", "out", "--passes", "20"}).find("multiples") != std::string::npos);
    CHECK(refusal({"s.gltf", "-o", "out", "--receivers", "plane,roof"}).find("allowed: plane, gonio, away") !=
          std::string::npos);
    CHECK(refusal({"s.gltf", "-o", "out", "--points", "7"}).find("5, 9, 13") != std::string::npos);
    CHECK(refusal({"s.gltf", "-o", "out", "--error", "0.1", "--error-of", "best"}).find("mean or worst") !=
          std::string::npos);
}

TEST_CASE("one run renders several receivers, and its parts merge to the same images") {
    Executable program;
    write_text(program.folder / "s.gltf", scene_text);
    const auto render = [&](std::vector<std::string> more) {
        std::vector<std::string> words = {"render", "s.gltf", "--receiver",  "plane,gonio,away",
                                          "--seed", "3",      "--algorithm", "bidirectional"};
        words.insert(words.end(), more.begin(), more.end());
        return program.run(words);
    };
    const Run whole = render({"-o", "whole.exr", "--passes", "64", "--stats", "stats.json"});
    CAPTURE(whole.err);
    REQUIRE(whole.code == 0);
    CHECK(!std::filesystem::exists(program.folder / "whole.exr"));
    const Image plane = read_exr(program.folder / "whole.plane.exr"),
                gonio = read_exr(program.folder / "whole.gonio.exr");
    CHECK(plane.width == 8);
    CHECK(gonio.height == 7);
    CHECK(std::get<std::string>(plane.attributes.at("pixelUnit")) == "lx");
    CHECK(std::get<std::string>(gonio.attributes.at("pixelUnit")) == "cd");
    CHECK(std::get<std::string>(gonio.attributes.at("receiver")) == "gonio");
    double lux = 0, candela = 0;
    for (float x : plane_of(plane)) lux += x / 64;
    for (float x : plane_of(gonio)) candela += x / 56;
    CHECK(std::fabs(lux - 201.35792) < 1);  // 1000 cd 2 m above 2 x 2 m
    CHECK(std::fabs(candela - 1000) < 60);
    for (float x : plane_of(read_exr(program.folder / "whole.away.exr"))) CHECK(x == 0);
    for (const char* receiver : {"plane", "gonio", "away"})
        CHECK(text_of(program, "stats.json").find(receiver) != std::string::npos);

    REQUIRE(render({"--passes", "0:40", "--checkpoint", "a.etd"}).code == 0);
    REQUIRE(render({"--passes", "40:64", "--checkpoint", "b.etd"}).code == 0);
    REQUIRE(program.run({"merge", "a.etd", "b.etd", "-o", "merged.exr"}).code == 0);
    for (const char* receiver : {"plane", "gonio", "away"}) {
        CAPTURE(receiver);
        CHECK(read_exr(program.folder / fmt::format("merged.{}.exr", receiver)).values ==
              read_exr(program.folder / fmt::format("whole.{}.exr", receiver)).values);
    }
    const Run fewer =
        program.run({"render", "s.gltf", "--receiver", "plane", "--passes", "64", "--resume", "a.etd"});
    CHECK(fewer.code == 2);
    CHECK(fewer.error_lines() == 1);
    for (const char* names : {"plane,plane", "plane,nobody", "plane,,gonio"}) {
        CAPTURE(names);
        const Run bad = program.run({"render", "s.gltf", "--receiver", names, "--passes", "1"});
        CHECK(bad.code == 2);
        CHECK(bad.error_lines() == 1);
    }
    REQUIRE(program.run({"render", "s.gltf", "--receiver", "all", "--passes", "1", "-o", "all.exr"}).code ==
            0);
    CHECK(std::filesystem::exists(program.folder / "all.away.exr"));
}

TEST_CASE("recorded rays are written, and parts merge to those of one run") {
    Executable program;
    std::string scene = scene_text;
    const std::string gonio = R"({"class": "intensity", "resolution": [8, 7]})";
    scene.replace(scene.find(gonio), gonio.size(), R"({"class": "rays", "radius": 4, "limit": 2000})");
    write_text(program.folder / "s.gltf", scene);
    const auto measure = [&](std::vector<std::string> more) {
        more.insert(more.begin(), {"measure", "s.gltf", "-q"});
        return program.run(more).code;
    };
    REQUIRE(measure({"--passes", "32", "-o", "out"}) == 0);
    const RayFile file = read_ray_file(program.folder / "out/gonio.tm25ray");
    CHECK(file.rays.size() == 2000);
    CHECK(file.flux() == doctest::Approx(4000 * 3.14159265).epsilon(0.02));
    CHECK_FALSE(std::filesystem::exists(program.folder / "out/plane.tm25ray"));
    REQUIRE(measure({"--passes", "0:16", "--checkpoint", "a.etd"}) == 0);
    REQUIRE(measure({"--passes", "16:32", "--checkpoint", "b.etd"}) == 0);
    REQUIRE(program.run({"merge", "b.etd", "a.etd", "-o", "merged"}).code == 0);
    CHECK(text_of(program, "merged/gonio.tm25ray") == text_of(program, "out/gonio.tm25ray"));
    CHECK(text_of(program, "merged/figures.csv") == text_of(program, "out/figures.csv"));

    const Run backward = program.run(
        {"measure", "s.gltf", "-o", "dark", "--passes", "16", "--algorithm", "backward"});
    CHECK(backward.code == 0);
    CHECK(backward.err.find("gonio: no rays have been recorded") != std::string::npos);
}

TEST_CASE("a meter on a mesh is reported side by side, with a table by triangle; parts merge") {
    Executable program;
    std::string scene = scene_text;
    const std::string gonio = R"({"class": "intensity", "resolution": [8, 7]}}}})";
    // A triangle in the xz plane, 2 m² below the lamp.
    scene.replace(scene.find(gonio), gonio.size(), R"({"class": "surface"}}}, "mesh": 0})");
    scene.insert(scene.rfind('}'), R"(, "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"bufferView": 0, "count": 3, "type": "VEC3", "componentType": 5126, "min": [-1, -1, 0], "max": [1, 1, 0]}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}], "buffers": [{"byteLength": 36, "uri":
        "data:application/octet-stream;base64,AACAvwAAgL8AAAAAAACAPwAAgL8AAAAAAACAvwAAgD8AAAAA"}])");
    write_text(program.folder / "s.gltf", scene);
    const Run run = program.run({"measure", "s.gltf", "-o", "out", "--passes", "32"});
    CAPTURE(run.err);
    REQUIRE(run.code == 0);
    const std::string table = text_of(program, "out/gonio.csv");
    CHECK(table.rfind("triangle,x_m,y_m,z_m,area_m2,front_illuminance_lx,", 0) == 0);
    CHECK(std::count(table.begin(), table.end(), '\n') == 2);
    CHECK(table.find("\n0,-0.333333,") != std::string::npos);
    const std::string figures = text_of(program, "out/figures.csv");
    for (const char* part : {"front, illuminance: flux", "back, illuminance: mean", "front, exitance: flux",
                             "back, exitance: mean"})
        CHECK(figures.find(part) != std::string::npos);
    REQUIRE(program.run({"measure", "s.gltf", "-q", "--passes", "0:16", "--checkpoint", "a.etd"}).code == 0);
    REQUIRE(program.run({"measure", "s.gltf", "-q", "--passes", "16:32", "--checkpoint", "b.etd"}).code == 0);
    REQUIRE(program.run({"merge", "b.etd", "a.etd", "-o", "merged"}).code == 0);
    CHECK(text_of(program, "merged/gonio.csv") == table);
    CHECK(text_of(program, "merged/figures.csv") == figures);
}
