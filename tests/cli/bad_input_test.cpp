// What goes wrong ends with one line on stderr, the exit code of its kind, and every file as it was.
#include <functional>

#include "tests/cli/program.h"
#include "tests/support/source_path.h"

using namespace etendue;

namespace {

using Words = std::vector<std::string>;

struct BadInput {
    std::string what;
    Words words;
    int code;
    Words named;  // what the line must say
    std::string scene = small_scene();
    std::function<void(Executable&)> prepare = [](Executable&) {};
};

const Words render = {"render", "s.gltf", "-o", "out.exr", "--passes", "1", "--size", "4x4"};

Words with(const Words& more) {
    Words words = render;
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

// A surface class of the scene's own, and the scene that brings it.
const char* const velvet = R"(
struct Velvet { float tint; //: 0.5 in [0, 1]. Reflectance.
};
SurfacePair velvet_evaluate(Velvet r, SurfaceContext c, vec3 wo, vec3 wi) { return no_surface_pair(); }
)";
std::string with_class_file() {
    std::string scene = small_scene();
    const std::string before = R"("extensions": {"ETD_optics": {"environment")";
    return scene.replace(scene.rfind(before), before.size(),
                         R"("extensions": {"ETD_optics": {"class_files": [{"interface": "surface", "file":
"evil.glsl"}], "environment")");
}

// Beside what it needs, a sky has that.
std::string sky_scene(const std::string& more) {
    std::string scene = small_scene();
    const std::string before = R"({"class": "constant", "radiance": 1})";
    return scene.replace(scene.rfind(before), before.size(), R"({"class": "sky", )" + more + "}");
}

// With another shape than a sphere.
std::string shape_scene(const std::string& shape) {
    std::string scene = small_scene();
    const std::string before = R"("class": "sphere", "radius": 1)";
    return scene.replace(scene.rfind(before), before.size(), shape);
}

// A lamp over a meter.
std::string lamp_scene(const std::string& lamp) {
    return R"({"asset": {"version": "2.0"}, "extensionsUsed": ["ETD_optics"], "nodes": [
{"name": "lamp", "translation": [0, 0, 3], "extensions": {"ETD_optics": {"light": )" +
           lamp + R"(}}}, {"name": "floor", "extensions": {"ETD_optics": {"receiver":
{"class": "illuminance", "size": [1, 1], "resolution": [4, 4]}}}}], "scenes": [{"nodes": [0, 1]}], "scene": 0})";
}

// out.exr is there before each of these runs, and must be untouched after it.
void check(const std::vector<BadInput>& inputs) {
    for (const BadInput& bad : inputs) {
        CAPTURE(bad.what);
        Executable program;
        write_text(program.folder / "out.exr", "precious");
        write_text(program.folder / "s.gltf", bad.scene);
        bad.prepare(program);
        const auto entries = [&] {
            Words names;
            for (const auto& entry : std::filesystem::directory_iterator(program.folder.path))
                if (const std::string name = entry.path().filename(); !name.starts_with("std"))
                    names.push_back(name);
            std::sort(names.begin(), names.end());
            return names;
        };
        const Words before = entries();
        const Run run = program.run(bad.words);
        CAPTURE(run.err);
        CHECK(run.code == bad.code);
        CHECK(run.error_lines() == 1);
        CHECK(run.err.starts_with("etendue: "));
        CHECK(run.out.empty());
        for (const std::string& word : bad.named) {
            CAPTURE(word);
            CHECK(run.err.find(word) != std::string::npos);
        }
        CHECK(read_text(program.folder / "out.exr") == "precious");
        CHECK(entries() == before);
    }
}

}  // namespace

TEST_CASE("a bad scene is one line with file, place and what is allowed, and nothing is written") {
    check({
        {"missing", {"render", "nothing.gltf", "-o", "out.exr"}, 2, {"nothing.gltf"}},
        {"a folder", {"render", ".", "-o", "out.exr"}, 2, {}},
        {"not glTF", render, 2, {"s.gltf"}, "hello\n"},
        {"an empty file", render, 2, {"s.gltf"}, ""},
        {"cut short", render, 2, {"s.gltf"}, small_scene().substr(0, 200)},
        {"nothing in it", render, 2, {"s.gltf", "empty"}, R"({"asset": {"version": "2.0"}})"},
        {"a .glb cut short",
         {"render", "s.glb", "-o", "out.exr"},
         2,
         {"s.glb"},
         "",
         [](Executable& p) {
             write_text(p.folder / "s.glb", std::string("glTF\2\0\0\0\0\1\0\0\x40\0\0\0JSON{\"asset\"", 28));
         }},
        {"an asphere that is wider than its sphere",
         {"inspect", "s.gltf"},
         2,
         {"s.gltf", "geometry", "asphere"},
         shape_scene(R"("class": "asphere", "curvature": 2, "aperture": 0.6)")},
        {"nine coefficients",
         {"inspect", "s.gltf"},
         2,
         {"s.gltf", "/coefficients", "at most 8"},
         shape_scene(R"("class": "asphere", "aperture": 0.6, "coefficients": [0, 0, 0, 0, 0, 0, 0, 0, 1])")},
        {"patches of fifteen points",
         {"inspect", "s.gltf"},
         2,
         {"s.gltf", "/control_points", "16 points"},
         shape_scene(R"("class": "bezier_patch", "control_points": [[0, 0, 0], [1, 0, 0], [0, 1, 0]])")},
        {"a spline of degree 4",
         {"inspect", "s.gltf"},
         2,
         {"s.gltf", "/degree/1", "4"},
         shape_scene(
             R"("class": "nurbs_patch", "degree": [1, 4], "knots": [[0, 0, 1, 1], [0]], "control_points": [])")},
        {"an unknown class",
         render,
         2,
         {"s.gltf", "/materials/0", "velvet", "lambertian"},
         small_scene(R"({"class": "velvet"})")},
        {"an unknown parameter",
         render,
         2,
         {"s.gltf", "/materials/0", "shininess", "reflectance"},
         small_scene(R"({"class": "lambertian", "shininess": 1})")},
        {"a wrong type",
         render,
         2,
         {"s.gltf", "/materials/0", "alpha"},
         small_scene(R"({"class": "conductor", "alpha": "smooth"})")},
        {"a value out of range",
         render,
         2,
         {"s.gltf", "/materials/0", "alpha", "[0, 1]"},
         small_scene(R"({"class": "conductor", "alpha": 2})")},
        {"a reflectance above 1",
         render,
         2,
         {"s.gltf", "/materials/0", "reflectance"},
         small_scene(R"({"class": "lambertian", "reflectance": [0.5, 1.5, 0.5]})")},
        {"a radius of zero",
         render,
         2,
         {"s.gltf", "/nodes/0", "radius"},
         small_scene(R"({"class": "lambertian"})", "0")},
        {"a measured surface without its file",
         render,
         2,
         {"s.gltf", "/materials/0", "file", ".bsdf"},
         small_scene(R"({"class": "measured"})")},
        {"a measured surface whose file is missing",
         render,
         2,
         {"paper.json"},
         small_scene(R"({"class": "measured", "file": "paper.json"})")},
        {"a measured surface of a bad table",
         render,
         2,
         {"paper.json", "/theta_i/1", "[0, 90]"},
         small_scene(R"({"class": "measured", "file": "paper.json"})"),
         [](Executable& p) { write_text(p.folder / "paper.json", R"({"theta_i": [0, 100]})"); }},
        {"a measured surface of a file cut short",
         render,
         2,
         {"gold.bsdf", "list of fields"},
         small_scene(R"({"class": "measured", "file": "gold.bsdf"})"),
         [](Executable& p) {
             write_text(p.folder / "gold.bsdf", std::string("tensor_file\0\1\0\7\0\0\0\5\0ndf", 23));
         }},
        {"a Mueller surface without matrix and file",
         render,
         2,
         {"s.gltf", "/materials/0", "neither matrix nor file"},
         small_scene(R"({"class": "mueller"})")},
        {"a Mueller surface with a file that is turned",
         render,
         2,
         {"s.gltf", "/materials/0", "file", "nothing else"},
         small_scene(R"({"class": "mueller", "file": "gold.pbsdf", "axis": 1})")},
        {"a Mueller surface whose file is missing",
         render,
         2,
         {"gold.pbsdf"},
         small_scene(R"({"class": "mueller", "file": "gold.pbsdf"})")},
        {"a Mueller surface of a file without matrices",
         render,
         2,
         {"gold.pbsdf", "phi_d", "missing"},
         small_scene(R"({"class": "mueller", "file": "gold.pbsdf"})"),
         [](Executable& p) {
             write_text(p.folder / "gold.pbsdf", std::string("tensor_file\0\1\0\0\0\0\0", 18));
         }},
        {"a photometric file that ends too early",
         render,
         2,
         {"lamp.ies", "line 8", "ends before intensity 3 of 5"},
         lamp_scene(R"({"class": "ies", "file": "lamp.ies"})"),
         [](Executable& p) {
             write_text(p.folder / "lamp.ies",
                        read_text(source_path("tests/host/photometry/own_bad_truncated.ies")));
         }},
        {"a photometric file of an unknown kind",
         render,
         2,
         {"s.gltf", "allowed: .ies, .ldt"},
         lamp_scene(R"({"class": "ies", "file": "s.gltf"})")},
        {"a lamp without its photometric file",
         render,
         2,
         {"s.gltf", "/nodes/0", "needs the parameter file"},
         lamp_scene(R"({"class": "ies"})")},
        {"a sky of type 16",
         render,
         2,
         {"s.gltf", "/extensions/ETD_optics/environment/type", "[1, 15]"},
         sky_scene(R"("diffuse": 1, "type": 16)")},
        {"a clear sky without its sun",
         render,
         2,
         {"s.gltf", "/extensions/ETD_optics/environment", "lacks sun, which a sky of type 12 needs"},
         sky_scene(R"("diffuse": 1)")},
        {"light of a sun that has set",
         render,
         2,
         {"s.gltf", "/environment/sun", "5.74° below the horizon"},
         sky_scene(R"("type": 1, "diffuse": 1, "direct": 1, "sun": [1, -0.1005, 0])")},
        {"a sun by direction and place",
         render,
         2,
         {"s.gltf", "/environment/sun/direction", "latitude, longitude, time, north"},
         sky_scene(R"("diffuse": 1, "sun": {"direction": [0, 1, 0], "latitude": 48})")},
        {"a sun at a moment without zone",
         render,
         2,
         {"s.gltf", "/environment/sun/time", "with its zone"},
         sky_scene(
             R"("diffuse": 1, "sun": {"latitude": 48, "longitude": 11, "time": "2026-06-21T12:00:00"})")},
        {"a black sky",
         render,
         2,
         {"s.gltf", "/environment/color", "black"},
         sky_scene(R"("type": 5, "diffuse": 1, "color": 0)")},
        {"a ray file that ends too early",
         render,
         2,
         {"led.tm25ray", "byte 20", "3 rays of 28 bytes"},
         lamp_scene(R"({"class": "rays", "file": "led.tm25ray"})"),
         [](Executable& p) {
             write_text(p.folder / "led.tm25ray",
                        read_text(source_path("tests/host/rays/own_bad_truncated.tm25ray")));
         }},
        {"a ray file of no kind that is known",
         render,
         2,
         {"s.gltf", "byte 0", "allowed: TM-25"},
         lamp_scene(R"({"class": "rays", "file": "s.gltf"})")},
        {"a color for rays that have spectra",
         render,
         2,
         {"s.gltf", "/nodes/0", "led.tm25ray has spectra of its own", "no color"},
         lamp_scene(R"({"class": "rays", "file": "led.tm25ray", "color": [1, 0, 0]})"),
         [](Executable& p) {
             write_text(p.folder / "led.tm25ray",
                        read_text(source_path("tests/host/rays/own_3rays_wavelength.tm25ray")));
         }},
        {"a class file that nobody allowed",
         render,
         2,
         {"s.gltf", "/extensions/ETD_optics/class_files/0", "evil.glsl", "--allow-class-files"},
         with_class_file(),
         [](Executable& p) { write_text(p.folder / "evil.glsl", velvet); }},
        {"a device for a file",
         render,
         2,
         {"s.gltf", "/dev/zero", "regular file"},
         small_scene(R"({"class": "measured", "file": "/dev/zero"})")},
        {"a name with control characters",
         render,
         2,
         {"s.gltf", "\\x1b[2J"},
         small_scene(R"({"class": "velvet\u001b[2J"})")},
        {"no such variant", with({"--variant", "midnight"}), 2, {"s.gltf", "midnight", "none"}},
        {"a moment before all others", with({"--at", "-1"}), 2, {"--at", "0 to 1e9"}},
        {"densities without any extent",
         render,
         2,
         {"s.gltf", "/extensions/ETD_optics/media/0", "1e-12"},
         R"({"asset": {"version": "2.0"}, "extensionsUsed": ["ETD_optics"], "extensions": {"ETD_optics": {"media": [
{"name": "smoke", "class": "grid", "file": "smoke.nrrd"}], "environment": {"class": "constant"}}}})",
         [](Executable& p) {
             write_text(p.folder / "smoke.nrrd",
                        "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: raw\n"
                        "spacings: 1 1e-30 1\n\nabcdefgh");
         }},
        {"a number too large", render, 2, {"s.gltf"}, small_scene(R"({"class": "lambertian"})", "1e999")},
    });
}

TEST_CASE("bad options and files beside the scene are one line, and nothing is written") {
    check({
        {"no such receiver", with({"--receiver", "ear"}), 2, {"ear", "eye"}},
        {"output folder missing", {"render", "s.gltf", "-o", "no/folder/x.exr"}, 2, {"no/folder"}},
        {"output not .exr", {"render", "s.gltf", "-o", "x.png"}, 2, {"x.png", ".exr"}},
        {"output a folder",
         {"render", "s.gltf", "-o", "dir.exr"},
         2,
         {"dir.exr"},
         small_scene(),
         [](Executable& p) { std::filesystem::create_directory(p.folder / "dir.exr"); }},
        {"stats that cannot be written", with({"--stats", "no/folder/s.json"}), 2, {"no/folder"}},
        {"checkpoint that cannot be written", with({"--checkpoint", "no/folder/state"}), 2, {"no/folder"}},
        {"environment missing", with({"--environment", "sky.hdr"}), 2, {"sky.hdr"}},
        {"environment not an image", with({"--environment", "s.gltf"}), 2, {"s.gltf"}},
        {"checkpoint missing", with({"--resume", "state"}), 2, {"state"}},
        {"checkpoint that is none", with({"--resume", "out.exr"}), 2, {"out.exr"}},
        {"shaders missing", with({"--shaders", "nowhere"}), 2, {"nowhere"}},
        {"no command", {}, 2, {"render"}},
        {"unknown command", {"paint"}, 2, {"paint", "render"}},
        {"unknown option", with({"--sharpness", "3"}), 2, {"--sharpness"}},
        {"no passes", with({"--passes", "0"}), 2, {"--passes"}},
        {"passes and a time", with({"--time", "3"}), 2, {"--time"}},
        {"size without width", with({"--size", "x4"}), 2, {"--size"}},
        {"no such class", {"classes", "velvet"}, 2, {"velvet"}},
        {"no such class for a page", {"classes", "velvet", "--html", "p.html"}, 2, {"velvet"}},
        {"a page that is none", {"classes", "--html", "out.exr"}, 2, {"out.exr", ".html"}},
        {"a page that cannot be written", {"classes", "--html", "no/folder/p.html"}, 2, {"no/folder"}},
        {"a page of no passes", {"classes", "--html", "p.html", "--passes", "0"}, 2, {"--passes"}},
        {"passes without a page", {"classes", "--passes", "3"}, 2, {"--passes", "--html"}},
        {"image to compare missing", {"compare", "a.exr", "b.exr"}, 2, {"a.exr"}},
        {"image to compare that is none", {"compare", "out.exr", "out.exr"}, 2, {"out.exr"}},
    });
}

TEST_CASE("without a usable device the exit code is 3, and nothing is written") {
    check({
        {"no such device", with({"--device", "no such card"}), 3, {"no such card"}},
        {"no such device for a page",
         {"classes", "--html", "p.html", "--device", "no such card"},
         3,
         {"no such card"}},
        {"no Vulkan device",
         render,
         3,
         {"Vulkan"},
         small_scene(),
         [](Executable& p) {
             p.environment = {{"VK_DRIVER_FILES", "/nonexistent"}, {"VK_ICD_FILENAMES", "/nonexistent"}};
         }},
        {"no Vulkan device to list",
         {"devices"},
         3,
         {"Vulkan"},
         small_scene(),
         [](Executable& p) {
             p.environment = {{"VK_DRIVER_FILES", "/nonexistent"}, {"VK_ICD_FILENAMES", "/nonexistent"}};
         }},
    });
}

TEST_CASE("a folder in which nothing can be made is one line") {
    Executable program;  // /proc takes no new files, not even from the superuser
    write_text(program.folder / "s.gltf", small_scene());
    const Run run = program.run({"render", "s.gltf", "-o", "/proc/out.exr"});
    CHECK(run.code == 2);
    CHECK_MESSAGE(run.error_lines() == 1, run.err);
    CHECK_MESSAGE(run.err.find("/proc/out.exr") != std::string::npos, run.err);
}
