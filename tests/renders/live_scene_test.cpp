// Scenes that are edited while they are rendered: a change shows what a scene file with the new values shows,
// and compiles no more than that needs.
#include <algorithm>
#include <cmath>

#include "host/error.h"
#include "host/gpu/shader_compiler.h"
#include "host/scene/live_places.h"
#include "host/scene/live_scene.h"
#include "tests/host/gltf_scene_builder.h"
#include "tests/support/class_file.h"
#include "tests/support/render_probe.h"
#include "tests/support/source_path.h"
#include "tests/support/temporary_folder.h"

using namespace etendue;
using nlohmann::json;
using Part = LiveObject::Part;

namespace {

struct Values {
    json reflectance = {0.8, 0.5, 0.2}, roughness = 0.2, radiance = 3.0, intensity = 2.0, radius = 0.5;
    json absorption = {0.2, 0.5, 1.0};
};

SceneBuilder room(const Values& v) {
    SceneBuilder s;
    s.medium("ink", {{"absorption", v.absorption}, {"ior", 1.3}});
    s.rectangle(4, 4, s.lambertian(v.reflectance), at(0, 0, -2));
    s.rectangle(1, 4, s.surface({{"class", "conductor"}, {"alpha", v.roughness}}), at(-1.5, 0, -1));
    s.sphere(0.2, s.black_emitter(v.radiance), at(0.5, 0.6, -1.2));
    const int ball = s.material({{"surface", {{"class", "dielectric"}}}, {"inside", "ink"}});
    s.shape({{"class", "sphere"}, {"radius", v.radius}}, ball, at(0, 0, 0));
    s.light({{"type", "point"}, {"intensity", v.intensity}}, at(-0.5, 0.7, 0.5));
    s.perspective(0.8, at(0, 0, 2.5));
    s.transform({10, 20, -30}, 1);
    return s;
}

std::vector<ExactSum> film(Scene& scene, Algorithm algorithm = Algorithm::bidirectional) {
    RenderSettings settings;
    settings.width = 24, settings.height = 24;
    settings.receiver = scene.receivers[0].ref;
    settings.algorithm = algorithm;
    Renderer renderer(test_device(), scene, settings);
    renderer.render_passes(4);
    return renderer.state().pixels;
}

std::vector<ExactSum> film_of(const Values& values, const std::set<std::string>& varying = {}) {
    SceneOptions options = test_options();
    options.varying = varying;
    Scene scene = compile_scene(test_device(), room(values).import(), options);
    return film(scene);
}

const LiveObject& find(const std::vector<LiveObject>& objects, Part part, size_t nth = 0) {
    for (const LiveObject& o : objects)
        if (o.part == part && nth-- == 0) return o;
    FAIL("no such object");
    return objects[0];
}

std::string write(const TemporaryFolder& folder, const SceneBuilder& scene) {
    write_text(folder / "scene.gltf", scene.document.dump());
    return (folder / "scene.gltf").string();
}

size_t compiled(const Scene& scene) {
    size_t count = 0;
    for (const KernelReport& k : scene.kernels) count += !k.from_store;
    return count;
}

}  // namespace

TEST_CASE("an edited scene shows what a file with the new values shows") {
    TemporaryFolder folder;
    LiveScene live(test_device(), write(folder, room({})), test_options());
    Values now;
    CHECK(film(*live.scene()) == film_of(now));
    std::set<std::string> varying;
    const auto edit = [&](const LiveObject& object, const std::string& name, const json& value) {
        const std::shared_ptr<Scene> next = live.set_parameter(object, name, value);
        CHECK(next != live.scene());
        live.accept();
        CHECK(next == live.scene());
        if (!object.class_name.empty())
            varying.insert(std::string(interface_info(interface_of(object.part)).name) + "/" +
                           object.class_name + "/" + name);
        CAPTURE(name);
        const std::vector<ExactSum> shown = film(*next);
        CHECK(shown == film_of(now, varying));
        return compiled(*next);
    };
    film(*live.scene());
    const auto objects = live.objects();
    now.reflectance = {0.1, 0.6, 0.3};
    CHECK(edit(find(objects, Part::surface, 0), "reflectance", now.reflectance) == 0);
    now.roughness = 0.4;
    CHECK(edit(find(objects, Part::surface, 1), "alpha", now.roughness) == 0);
    now.roughness = 0;  // a smooth metal: kernels have known it as one that may be rough
    CHECK(edit(find(objects, Part::surface, 1), "alpha", now.roughness) == 0);
    now.radiance = {1, 2, 9};
    CHECK(edit(find(objects, Part::emission, 2), "radiance", now.radiance) == 0);  // of the third material
    now.intensity = 7;
    CHECK(edit(find(objects, Part::light), "intensity", 7) == 0);
    now.absorption = {1, 0, 0};
    CHECK(edit(find(objects, Part::medium), "absorption", now.absorption) == 0);
    // Geometry stands in the kernels of so small a scene, until it is edited.
    varying.insert("places");
    for (const double radius : {0.4, 0.5, 0.45}) {
        now.radius = radius;
        const size_t count = edit(find(objects, Part::geometry, 3), "radius", radius);
        CHECK((count > 0) == (radius == 0.4));
    }
}

namespace {

// A ball of a medium in another one, beside a mesh, before a wall that shines.
struct Bodies {
    json ball = {{"surface", {{"class", "dielectric"}}}, {"inside", "ink"}};
    json shell = {{"surface", {{"class", "dielectric"}}}, {"inside", "oil"}};
    json wall = {{"surface", {{"class", "lambertian"}}}};
    json mesh = {{"translation", {0.9, 0, 0}}};
};

SceneBuilder bodies(const Bodies& b) {
    SceneBuilder s;
    s.medium("ink", {{"absorption", {0.2, 0.5, 1.0}}, {"ior", 1.3}});
    s.medium("oil", {{"absorption", {2.0, 0.2, 0.1}}, {"ior", 1.5}});
    s.sphere(0.4, s.material(b.ball), at(0, 0, 0));
    s.sphere(0.5, s.material(b.shell), at(0.2, 0, 0));
    s.rectangle(4, 4, s.material(b.wall), at(0, 0, -1));
    s.mesh({{-0.3f, -0.3f, 0}, {0.3f, -0.3f, 0}, {0, 0.4f, 0.2f}}, {0, 1, 2}, s.lambertian(0.6), at(0, 0, 0));
    s.document["nodes"].back().erase("rotation");
    s.document["nodes"].back().update(b.mesh);
    s.document["nodes"].back()["name"] = "flag";
    s.environment(1);
    s.perspective(0.8, at(0, 0, 3));
    return s;
}

const LiveObject& find_place(const std::vector<LiveObject>& objects, const std::string& name) {
    for (const LiveObject& o : objects)
        if (o.part == Part::place && o.name == name) return o;
    FAIL("no such place");
    return objects[0];
}

json quaternion(double degrees, const glm::dvec3& axis) {
    const double half = glm::radians(degrees) / 2;
    return {std::sin(half) * axis.x, std::sin(half) * axis.y, std::sin(half) * axis.z, std::cos(half)};
}

std::vector<float> picture(Scene& scene) {
    RenderSettings settings;
    settings.width = 24, settings.height = 24;
    settings.receiver = scene.receivers[0].ref;
    settings.algorithm = Algorithm::backward;
    Renderer renderer(test_device(), scene, settings);
    renderer.render_passes(4);
    return renderer.develop(false).values;
}

double relative_difference(const std::vector<float>& a, const std::vector<float>& b) {
    REQUIRE(a.size() == b.size());
    double sum = 0, difference = 0;
    for (size_t i = 0; i < a.size(); ++i)
        sum += std::abs(a[i]) + std::abs(b[i]), difference += std::abs(a[i] - b[i]);
    return difference / sum;
}

}  // namespace

TEST_CASE("media, priorities, emission and places that are edited show what a file with them shows") {
    TemporaryFolder folder;
    Bodies now;
    LiveScene live(test_device(), write(folder, bodies(now)), test_options());
    std::set<std::string> varying;
    std::vector<float> before = picture(*live.scene());
    const auto expected = [&] {
        SceneOptions options = test_options();
        options.varying = varying;
        Scene scene = compile_scene(test_device(), bodies(now).import(), options);
        return picture(scene);
    };
    const auto edit = [&](const LiveObject& object, const std::string& name, const json& value) {
        CAPTURE(name);
        live.set_parameter(object, name, value);
        live.accept();
        const std::vector<float> after = picture(*live.scene());
        CHECK(after != before);
        CHECK(relative_difference(after, expected()) < 1e-3);  // rotations are rounded otherwise
        before = after;
    };
    const auto objects = live.objects();
    const LiveObject ball = find(objects, Part::boundary, 0), shell = find(objects, Part::boundary, 1);
    now.ball["inside"] = "oil";
    edit(ball, "inside", "oil");
    now.ball["outside"] = "ink";
    edit(ball, "outside", "ink");
    now.ball.erase("outside"), now.ball["inside"] = "ink";
    live.set_parameter(ball, "outside", nullptr), live.accept();
    edit(ball, "inside", "ink");
    now.ball["priority"] = 2;
    edit(ball, "priority", 2);
    now.shell["priority"] = 1;
    live.set_parameter(shell, "priority", 1), live.accept();
    before = picture(*live.scene());
    now.shell["priority"] = 3;  // now the shell is before the ball
    edit(shell, "priority", 3);
    CHECK(find(live.objects(), Part::boundary, 1).parameters[2].value == 3);

    now.wall["emission"] = {{"radiance", {3, 1, 0.5}}};
    edit(find(live.objects(), Part::emission, 0), "radiance", {3, 1, 0.5});

    varying.insert("places");
    const LiveObject flag = find_place(objects, "flag");
    CHECK(flag.parameters[0].value == json({0.9, 0, 0}));
    now.mesh["translation"] = {0.7, 0.3, 0.4};
    edit(flag, "translation", {0.7, 0.3, 0.4});
    now.mesh["rotation"] = quaternion(70, {0, 1, 0});
    edit(flag, "rotation", {0, 70, 0});
    now.mesh["scale"] = {1.5, -0.5, 2};
    edit(flag, "scale", {1.5, -0.5, 2});
    CHECK(compiled(*live.scene()) == 0);  // where things stand is in no kernel any more
}

TEST_CASE("rotation and scale of a place can be read back, whatever the order they were set in") {
    SceneObjects scene;
    scene.shapes.resize(1);
    scene.lights.resize(1);
    edit_place(scene, 0, "scale", {2, 3, -4});
    edit_place(scene, 0, "rotation", {20, -50, 130});
    edit_place(scene, 0, "translation", {1, 2, 3});
    edit_place(scene, 0, "scale", {5, 6, 7});
    const auto value = [&](size_t which, int i) {
        return described_place(scene, 0).parameters[which].value[size_t(i)].get<double>();
    };
    const double expected[3][3] = {{1, 2, 3}, {20, -50, 130}, {5, 6, 7}};
    for (size_t which = 0; which < 3; ++which)
        for (int i = 0; i < 3; ++i) CHECK(value(which, i) == doctest::Approx(expected[which][i]));
    CHECK(described_place(scene, 1).parameters.size() == 2);  // a light
    // Shear stays.
    glm::dmat4& m = scene.shapes[0].world_from_local;
    m = glm::dmat4(1.0);
    m[1].x = 0.5;
    edit_place(scene, 0, "rotation", {0, 0, 90});
    CHECK(glm::length(glm::dvec3(m[1]) - glm::dvec3(-1, 0.5, 0)) < 1e-12);
}

TEST_CASE("media, priorities and places that cannot be leave the scene as it was") {
    TemporaryFolder folder;
    LiveScene live(test_device(), write(folder, bodies({})), test_options());
    const std::shared_ptr<Scene> scene = live.scene();
    const auto objects = live.objects();
    const LiveObject ball = find(objects, Part::boundary, 0), wall = find(objects, Part::boundary, 2),
                     flag = find_place(objects, "flag");
    const auto complaint = [&](const LiveObject& object, const std::string& name, const json& value) {
        try {
            live.set_parameter(object, name, value);
        } catch (const Error& error) {
            CHECK(error.code == ExitCode::bad_input);
            return std::string(error.what());
        }
        return std::string();
    };
    const auto says = [](const std::string& line, const char* what) {
        CAPTURE(line);
        CHECK(line.find(what) != std::string::npos);
        CHECK(line.find('\n') == std::string::npos);
    };
    says(complaint(ball, "inside", "milk"), "milk is not the name of a medium");
    says(complaint(ball, "inside", 3), "must name a medium");
    says(complaint(ball, "priority", -1), "whole number");
    says(complaint(ball, "priority", 1.5), "whole number");
    says(complaint(wall, "priority", 1), "must name a medium inside");
    says(complaint(ball, "thickness", 1), "allowed: inside, outside, priority");
    says(complaint(flag, "translation", {1, 2}), "three numbers");
    says(complaint(flag, "translation", {1, 2, 1e30}), "three numbers");
    says(complaint(flag, "scale", {1, 0, 1}), "must not be 0");
    says(complaint(flag, "shear", 1), "allowed: translation, rotation, scale");
    CHECK(live.scene() == scene);
    CHECK(find(live.objects(), Part::boundary, 0).parameters[0].value == "ink");
}

TEST_CASE("new classes, places and media take effect, and receivers that were moved stay") {
    TemporaryFolder folder;
    LiveScene live(test_device(), write(folder, room({})), test_options());
    const glm::dmat4 before = live.scene()->receivers[0].world_from_local;
    glm::dmat4 moved = before;
    moved[3].z -= 1;
    const auto objects = live.objects();
    CHECK(live.place(find(objects, Part::receiver), moved) == live.scene());
    const std::vector<ExactSum> seen = film(*live.scene());

    const LiveObject& wall = find(objects, Part::surface);
    live.set_class(wall, "conductor", {{"alpha", 0.3}});
    live.accept();
    CHECK(live.objects()[0].class_name == "conductor");
    const std::vector<ExactSum> of_metal = film(*live.scene());
    CHECK(of_metal != seen);
    CHECK(live.scene()->receivers[0].world_from_local == moved);

    const LiveObject& lamp = find(objects, Part::light);
    glm::dmat4 elsewhere = live.description().lights[0].world_from_local;
    elsewhere[3].x += 0.9;
    live.place(lamp, elsewhere);
    live.accept();
    CHECK(film(*live.scene()) != of_metal);

    // Back to the file: all edits are forgotten, but the receiver stays.
    live.reload();
    live.accept();
    CHECK(film(*live.scene()) == seen);
    SceneBuilder other = room({});
    other.document["nodes"].back()["translation"] = {0, 0, 4};
    write(folder, other);
    live.reload();
    live.accept();
    CHECK(live.scene()->receivers[0].world_from_local[3].z == before[3].z + 1.5);
}

TEST_CASE("what is wrong changes nothing and is told in the words of a scene file") {
    TemporaryFolder folder;
    const std::string file = write(folder, room({}));
    LiveScene live(test_device(), file, test_options());
    const auto objects = live.objects();
    const std::shared_ptr<Scene> scene = live.scene();
    const std::vector<ExactSum> seen = film(*scene);
    const auto message = [&](auto change) {
        try {
            change();
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    const std::string at = file + ": /materials/1/extensions/ETD_optics/surface";
    const LiveObject& metal = find(objects, Part::surface, 1);
    CHECK(message([&] { live.set_parameter(metal, "alpha", 2); }) ==
          at + "/alpha: 2 is out of range; allowed: a number in [0, 1]");
    CHECK(message([&] { live.set_parameter(metal, "roughness", 0.1); }).find("unknown parameter") !=
          std::string::npos);
    CHECK(message([&] {
              live.set_class(metal, "velvet");
          }).find(at + "/class: there is no surface class velvet") == 0);
    CHECK(message([&] { live.set_parameter(find(objects, Part::emission), "radiance", -1); }) != "");
    CHECK(message([&] { live.set_parameter(find(objects, Part::emission), "glow", 1); }) != "");
    write_text(file, "{");
    CHECK(message([&] { live.reload(); }).find("scene.gltf") != std::string::npos);
    live.accept();  // of nothing
    CHECK(live.scene() == scene);
    CHECK(find(live.objects(), Part::surface, 1).parameters[3].value == 0.2);
    CHECK(film(*live.scene()) == seen);
}

TEST_CASE("objects are listed with what their classes know of their parameters") {
    TemporaryFolder folder;
    LiveScene live(test_device(), write(folder, room({})), test_options());
    const auto objects = live.objects();
    // Four materials, each with its media and its emission, a medium with its phase function, four geometries
    // and a light with their places, a camera.
    CHECK(objects.size() == 4 * 3 + 2 + 4 * 2 + 2 + 1);
    const LiveObject& metal = find(objects, Part::surface, 1);
    CHECK(metal.class_name == "conductor");
    const LiveParameter& alpha = metal.parameters.at(3);
    CHECK(alpha.info.member.name == "alpha");
    CHECK(alpha.value == 0.2);
    CHECK(alpha.info.range() == "[0, 1]");
    CHECK(metal.parameters.at(4).value == false);  // multiscatter, by default
    CHECK(find(objects, Part::emission).parameters.at(0).info.member.name == "radiance");
    CHECK(find(objects, Part::phase).class_name == "isotropic");
    CHECK(find(objects, Part::light).parameters.at(1).info.unit == "cd");
}

TEST_CASE("a broken shader is one line, and the scene before it stays") {
    TemporaryFolder folder;
    const std::filesystem::path shaders = folder / "shaders";
    std::filesystem::copy(source_path("shaders"), shaders, std::filesystem::copy_options::recursive);
    SceneOptions options = test_options();
    options.shaders = shaders;
    LiveScene live(test_device(), write(folder, room({})), options);
    const std::vector<ExactSum> seen = film(*live.scene());
    const std::string lambertian = read_text(shaders / "surfaces/lambertian.glsl");
    write_text(shaders / "surfaces/lambertian.glsl", lambertian + "\nint x = ;\n");
    std::string message;
    try {
        const std::shared_ptr<Scene> next = live.reload();
        film(*next);
        live.accept();
    } catch (const Error& error) {
        message = error.what();
    }
    const auto line = 2 + std::count(lambertian.begin(), lambertian.end(), '\n');
    CHECK(message.find(fmt::format("surfaces/lambertian.glsl:{}: '' :  syntax error, unexpected SEMICOLON",
                                   line)) == 0);
    CHECK(film(*live.scene()) == seen);
    // Whole again, but a darker surface.
    std::string darker = lambertian;
    const size_t at = darker.find("INV_PI");
    REQUIRE(at != std::string::npos);
    write_text(shaders / "surfaces/lambertian.glsl", darker.replace(at, 6, "0.5 * INV_PI"));
    const std::shared_ptr<Scene> next = live.reload();
    CHECK(film(*next) != seen);
}

TEST_CASE("the variant and the moment of a file change, and where that fails all stays as it was") {
    TemporaryFolder folder;
    GltfBuilder b;
    b.document["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "night"}}};
    b.document["materials"] = {json::object(), {{"name", "dark"}}};
    json& primitive = b.triangle();
    primitive["material"] = 0;
    primitive["extensions"]["KHR_materials_variants"]["mappings"] = {{{"material", 1}, {"variants", {0}}}};
    const int input = b.accessor<float>("SCALAR", {0, 2}),
              output = b.accessor<float>("VEC3", {0, 0, 0, 8, 0, 0});
    b.document["animations"] = {
        {{"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}},
         {"samplers", {{{"input", input}, {"output", output}}}}}};
    const std::vector<uint8_t> bytes = b.glb();
    write_text(folder / "scene.glb", {bytes.begin(), bytes.end()});
    LiveScene live(test_device(), folder / "scene.glb", test_options());
    CHECK(live.description().animation_seconds == 2);
    live.reload({"night", 1});
    CHECK(live.import() == ImportOptions{});  // not before it is accepted
    live.accept();
    CHECK(live.import() == ImportOptions{"night", 1});
    CHECK(live.description().instances.at(0).world_from_local[3].x == 4);
    CHECK(live.description().meshes.at(0).material == 1);
    CHECK_THROWS_AS(live.reload({"noon", 1}), Error);
    CHECK(live.description().instances.at(0).world_from_local[3].x == 4);
    live.reload();  // as it is
    live.accept();
    CHECK(live.description().instances.at(0).world_from_local[3].x == 4);
}

TEST_CASE("class files run only where they are allowed, also once a file that is read again brings some") {
    TemporaryFolder folder;
    GltfBuilder b;
    b.triangle();
    const auto write = [&] {
        const std::vector<uint8_t> bytes = b.glb();
        write_text(folder / "scene.glb", {bytes.begin(), bytes.end()});
    };
    write();
    SceneOptions options = test_options();
    options.allow_class_files = false;
    LiveScene live(test_device(), folder / "scene.glb", options);
    write_text(folder / "chalk.glsl", chalk_class());
    b.document["extensions"]["ETD_optics"]["class_files"] = {
        {{"interface", "surface"}, {"file", "chalk.glsl"}}};
    write();
    CHECK_THROWS_AS(live.reload(), ClassFilesRefused);
    live.allow_class_files();
    CHECK(live.reload()->registry->find(Interface::surface, "chalk") != nullptr);
}
