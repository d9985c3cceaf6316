// What answers a window's requests, without a window.
#include "host/preview/worker.h"

#include <doctest/doctest.h>

#include <chrono>
#include <thread>

#include <cmath>

#include "host/error.h"
#include "host/preview/pixel_probe.h"
#include "host/preview/receiver_placement.h"
#include "tests/preview/two_balls.h"

using namespace etendue;

namespace {

struct Viewed {
    explicit Viewed(const std::string& text = two_balls, uint32_t spectral_bins = 0) {
        write_text(folder / "scene.gltf", text);
        options.scene = folder / "scene.gltf";
        options.passes = 4;
        options.spectral_bins = spectral_bins;
        worker = std::make_unique<PreviewWorker>(
            options, [this] { return interrupt && interrupt(); }, [] {});
        worker->open();
        request.width = 64, request.height = 48;
        request.algorithm = Algorithm::backward;
    }
    ~Viewed() {
        worker->run_task([](PreviewScene& scene) { CHECK(scene.device.validation_messages.empty()); });
    }
    const PreviewPicture& rest() {
        for (int i = 0; i < 100 && worker->work(request);) ++i;
        REQUIRE(worker->picture());
        CHECK(worker->picture()->request == request);
        return *worker->picture();
    }
    const LiveObject& object(LiveObject::Part part, uint32_t index = 0) {
        for (const LiveObject& o : *worker->status().objects)
            if (o.part == part && o.index == index) return o;
        throw std::runtime_error("no such object");
    }
    TemporaryFolder folder;
    ViewOptions options;
    std::function<bool()> interrupt;
    std::unique_ptr<PreviewWorker> worker;
    PreviewRequest request;
};

float green(const PreviewPicture& p, uint32_t x, uint32_t y) { return p.radiance[y * p.width + x].y; }

}  // namespace

TEST_CASE("a picture begins coarse and rests at full size with the passes that were asked for") {
    Viewed viewed;
    REQUIRE(viewed.worker->work(viewed.request));
    CHECK(viewed.worker->picture()->step == 16);
    CHECK(viewed.worker->picture()->width == 4);
    CHECK(viewed.worker->picture()->height == 3);
    const PreviewPicture& picture = viewed.rest();
    CHECK(picture.step == 1);
    CHECK(picture.passes == 4);
    CHECK(picture.radiance.size() == 64 * 48);
    CHECK(viewed.worker->status().at_rest);
    CHECK(!viewed.worker->work(viewed.request));
}

TEST_CASE("another size, camera, seed or algorithm begins anew; what is larger finds room") {
    Viewed viewed;
    const std::vector<glm::vec3> first = viewed.rest().radiance;
    viewed.request.seed = 1;
    CHECK(viewed.rest().radiance != first);
    viewed.request.seed = 0;
    CHECK(viewed.rest().radiance == first);
    viewed.request.receiver = 1;
    CHECK(viewed.rest().radiance != first);
    viewed.request.receiver = 0;
    viewed.request.width = 100, viewed.request.height = 80;
    CHECK(viewed.rest().radiance.size() == 100 * 80);
    viewed.request.width = 64, viewed.request.height = 48;
    CHECK(viewed.rest().radiance == first);
    viewed.request.placement = viewed.worker->status().receivers[0].placement;
    CHECK(viewed.rest().radiance == first);
    (*viewed.request.placement)[3].x += 0.5;
    CHECK(viewed.rest().radiance != first);
    viewed.request.placement.reset();
    viewed.request.algorithm = Algorithm::bidirectional;
    CHECK(viewed.rest().radiance != first);
    CHECK(viewed.worker->status().choice.algorithm == Algorithm::bidirectional);
    viewed.request.algorithm = Algorithm::automatic;
    viewed.rest();
    CHECK(viewed.worker->status().choice.algorithm == Algorithm::backward);
    CHECK(viewed.worker->status().message == "");
}

TEST_CASE("a pass that is interrupted halfway is not shown, and the film begins anew") {
    Viewed viewed, undisturbed;
    for (Viewed* v : {&viewed, &undisturbed}) v->request.width = 800, v->request.height = 600;
    viewed.rest();
    const auto before = viewed.worker->picture();
    viewed.request.seed = undisturbed.request.seed = 5;
    int asked = 0;
    viewed.interrupt = [&] { return ++asked == 2; };  // in the middle of the first pass
    CHECK(viewed.worker->work(viewed.request));
    if (asked == 2) CHECK(viewed.worker->picture() == before);  // a fast device is not asked twice
    viewed.interrupt = [] { return false; };
    CHECK(viewed.rest().radiance == undisturbed.rest().radiance);
}

TEST_CASE("an edit shows in the picture; one that is refused becomes a message, and nothing changes") {
    Viewed viewed;
    const std::vector<glm::vec3> first = viewed.rest().radiance;
    const auto edit = [&](const nlohmann::json& value) {
        const LiveObject object = viewed.object(LiveObject::Part::surface, 1);
        viewed.worker->run_task([&](PreviewScene& scene) {
            scene.next = scene.live.set_parameter(object, "reflectance", value);
        });
    };
    const float before = green(viewed.rest(), 42, 26);  // of the green ball
    edit({0.1, 0.35, 0.1});
    CHECK(green(viewed.rest(), 42, 26) < 0.7f * before);
    CHECK(viewed.worker->status().message == "");
    const std::vector<glm::vec3> edited = viewed.rest().radiance;
    edit(7.0);
    CHECK(viewed.worker->status().is_error);
    CHECK(viewed.worker->status().message.find("reflectance") != std::string::npos);
    CHECK(viewed.rest().radiance == edited);
    edit({0.1, 0.7, 0.1});
    CHECK(viewed.rest().radiance == first);
    CHECK(!viewed.worker->status().is_error);
}

TEST_CASE("on another device the scene is as it was edited, and the camera where it stood") {
    Viewed viewed;
    viewed.rest();
    const LiveObject object = viewed.object(LiveObject::Part::surface, 1);
    viewed.worker->run_task([&](PreviewScene& scene) {
        scene.next = scene.live.set_parameter(object, "reflectance", {0.1, 0.2, 0.6});
    });
    viewed.request.receiver = 1;
    viewed.request.placement = viewed.worker->status().receivers[1].placement;
    (*viewed.request.placement)[3].y += 0.25;
    const std::vector<glm::vec3> before = viewed.rest().radiance;
    CHECK(viewed.worker->replace_device());
    CHECK(viewed.worker->status().devices_lost == 1);
    CHECK(!viewed.worker->replace_device());  // it has made no picture yet
    CHECK(viewed.rest().radiance == before);
    CHECK(viewed.worker->replace_device());
    CHECK(viewed.rest().radiance == before);
}

TEST_CASE("layers: errors are known after some passes, normals point to the camera, depth is darker afar") {
    Viewed viewed;
    viewed.request.wants_errors = true;
    const PreviewPicture& picture = viewed.rest();
    REQUIRE(picture.errors.size() == picture.radiance.size());
    CHECK(picture.shown.empty());
    viewed.request.layer = Layer::error;
    CHECK(viewed.rest().shown.size() == 64 * 48);
    viewed.request.layer = Layer::normal;
    const glm::vec3 normal = 2.0f * viewed.rest().shown[26 * 64 + 42] - 1.0f;
    CHECK(normal.z > 0.5f);
    viewed.request.layer = Layer::depth;
    const PreviewPicture& depth = viewed.rest();
    CHECK(depth.shown[31 * 64 + 21].x > depth.shown[26 * 64 + 42].x);  // the red ball is nearer
    CHECK(depth.shown[0].x == 0);                                      // the sky
    viewed.request.layer = Layer::albedo;
    const glm::vec3 albedo = viewed.rest().shown[26 * 64 + 42];
    CHECK(albedo.y == doctest::Approx(0.7).epsilon(0.05));
}

TEST_CASE("layers of polarization, where a camera asks for Stokes vectors") {
    Viewed plain;
    plain.request.layer = Layer::linear;
    CHECK(plain.rest().stokes.empty());
    std::string text = two_balls;
    const std::string camera = R"({"name": "front", "camera": 0,)";
    text.replace(text.find(camera), camera.size(),
                 camera + R"( "extensions": {"ETD_optics": {"receiver": {"stokes": true}}},)");
    const std::string paint = R"({"class": "lambertian", "reflectance": [0.1, 0.7, 0.1]})";
    text.replace(text.find(paint), paint.size(),
                 R"({"class": "conductor", "eta": 0.2, "k": 3.4, "alpha": 0.3})");
    Viewed viewed(text);
    viewed.request.layer = Layer::linear;
    const PreviewPicture& picture = viewed.rest();
    REQUIRE(picture.stokes.size() == picture.radiance.size());
    CHECK(picture.shown.size() == picture.radiance.size());
    const glm::vec4 sky = picture.stokes[0];
    CHECK(sky.x == doctest::Approx(1).epsilon(1e-3));
    CHECK(std::abs(sky.y) + std::abs(sky.z) + std::abs(sky.w) == 0);
    float most = 0;
    for (const glm::vec4& s : picture.stokes) {
        CHECK(glm::length(glm::vec3(s.y, s.z, s.w)) <= s.x * 1.0001f);
        most = std::max(most, std::hypot(s.y, s.z) / s.x);
    }
    CHECK(most > 0.005f);  // light at the rim of the metal
    for (const Layer layer : {Layer::angle, Layer::circular}) {
        viewed.request.layer = layer;
        CHECK(viewed.rest().shown.size() == 64 * 48);
    }
}

TEST_CASE("a pixel tells what it sees, and its spectrum where the film has bins") {
    Viewed viewed(two_balls, 10);
    viewed.rest();
    PixelReading reading;
    viewed.worker->run_task([&](PreviewScene& scene) { reading = read_pixel(scene, {42, 26}); });
    REQUIRE(reading.seen.hit);
    CHECK(reading.surface_class == "lambertian");
    CHECK(reading.seen.material == 1);
    // On the green ball, of radius 0.8 around (0.8, 0.2, -1); the camera stands at (0, 0.5, 5).
    CHECK(glm::length(reading.seen.position - glm::dvec3(0.8, 0.2, -1)) ==
          doctest::Approx(0.8).epsilon(1e-4));
    CHECK(glm::length(reading.seen.position - glm::dvec3(0, 0.5, 5)) ==
          doctest::Approx(double(reading.seen.distance)).epsilon(1e-4));
    REQUIRE(reading.spectrum.size() == 10);
    viewed.worker->run_task([&](PreviewScene& scene) { reading = read_pixel(scene, {2, 2}); });
    CHECK(!reading.seen.hit);
}

// A camera within a sphere of graded index, n² = 2.56 (1 - r²/2) with r from the z axis, and a ball in its
// way that gives way to it.
constexpr const char* camera_within_rod =
    R"({"asset": {"version": "2.0"}, "extensionsUsed": ["ETD_optics"], "scene": 0, "scenes": [{"nodes": [0, 1, 2]}],
"nodes": [{"extensions": {"ETD_optics": {"geometry": {"class": "sphere", "radius": 1.1, "material": 0}}}},
          {"translation": [0.45, 0, 0], "extensions": {"ETD_optics": {"geometry": {"class": "sphere", "radius": 0.3, "material": 1}}}},
          {"camera": 0, "translation": [0.6, 0.1, 0.7]}],
"materials": [{"name": "end", "extensions": {"ETD_optics": {"surface": {"class": "boundary"}, "inside": "rod", "priority": 2}}},
              {"name": "ball", "extensions": {"ETD_optics": {"surface": {"class": "boundary"}, "inside": "glass", "priority": 1}}}],
"cameras": [{"type": "orthographic", "orthographic": {"xmag": 0.1, "ymag": 0.1, "znear": 0, "zfar": 100}}],
"extensions": {"ETD_optics": {"environment": {"class": "constant", "radiance": 1},
  "media": [{"name": "rod", "class": "gradient_index", "ior": 1.6, "radial": [-0.5, 0, 0], "tolerance": 2e-5},
            {"name": "glass", "class": "homogeneous", "ior": 1.5}]}}})";

TEST_CASE("the pointer picks what bent rays come to, past faces that are not there") {
    Viewed viewed(camera_within_rod);
    viewed.rest();
    PixelReading reading;
    SeenPoint seen;
    viewed.worker->run_task([&](PreviewScene& scene) {
        reading = read_pixel(scene, {32, 24});
        seen = see_point(scene, {0.5, 0.5});
    });
    CHECK(reading.material == "end");
    REQUIRE(seen.hit);
    // x and y go with cos(1.6 t / sqrt(2)), and z falls by n t, where n is the index at the start: n ds is n²
    // dt.
    const auto index_squared = [](const glm::dvec3& p) { return 2.56 * (1 - (p.x * p.x + p.y * p.y) / 2); };
    const glm::dvec3 start{0.6, 0.1, 0.7};
    const double fall = std::sqrt(index_squared(start)), dt = 1e-5;
    glm::dvec3 end = start;
    double way = 0;
    for (double t = dt / 2; glm::length(end) < 1.1; t += dt) {
        const double turned = std::cos(1.6 * t / std::sqrt(2));
        end = {start.x * turned, start.y * turned, start.z - fall * t};
        way += std::sqrt(index_squared(end)) * dt;
    }
    CHECK(glm::length(seen.position - end) < 1e-4);
    CHECK(std::abs(double(seen.distance) - way) < 1e-4);
}

TEST_CASE("a camera that is copied as glTF is the camera") {
    Viewed viewed;
    viewed.rest();
    nlohmann::json gltf;
    viewed.worker->run_task(
        [&](PreviewScene& scene) { gltf = camera_as_gltf(scene.scene.receivers[1], 1.5); });
    CHECK(gltf["cameras"][0]["type"] == "orthographic");
    CHECK(gltf["cameras"][0]["orthographic"]["ymag"] == 1.5);
    CHECK(gltf["cameras"][0]["orthographic"]["xmag"] == 2.25);
    const auto matrix = gltf["nodes"][0]["matrix"].get<std::vector<double>>();
    REQUIRE(matrix.size() == 16);
    CHECK(matrix[12] == doctest::Approx(5));
    CHECK(matrix[13] == doctest::Approx(0.3));
}

TEST_CASE("a start notes its programs, and the next one of the same scene has them made ahead") {
    Viewed viewed;
    CHECK(StartPrograms(viewed.options).read().empty());
    viewed.rest();
    std::map<uint64_t, std::string> noted;
    for (const ExpectedProgram& program : StartPrograms(viewed.options).read()) {
        CHECK(std::filesystem::exists(program.spirv));
        noted[program.key] = program.spirv.filename().string();
    }
    for (const KernelReport& kernel : viewed.worker->status().kernels) {
        REQUIRE(noted.contains(kernel.key));
        CHECK(noted[kernel.key].starts_with(kernel.name + "-"));
    }
    ViewOptions other = viewed.options;
    other.color = ColorMode::spectral;
    CHECK(StartPrograms(other).read().empty());

    PreviewWorker again(viewed.options, {}, [] {});
    again.open();
    CHECK(again.work(viewed.request));
    for (const KernelReport& kernel : again.status().kernels)
        if (kernel.name == "trace_paths") CHECK(kernel.from_store);  // the largest, which is begun first
    CHECK(again.picture()->radiance.size() > 0);

    CHECK(!StartPrograms(viewed.options).needs_color_spectra());
    auto scene = nlohmann::json::parse(two_balls);
    scene["materials"][0] = {{"pbrMetallicRoughness", {{"baseColorFactor", {0.8, 0.1, 0.1, 1}}}}};
    write_text(viewed.folder / "painted.gltf", scene.dump());
    other.scene = viewed.folder / "painted.gltf";
    PreviewWorker painted(other, {}, [] {});
    painted.open();
    CHECK(painted.work(viewed.request));
    CHECK(StartPrograms(other).needs_color_spectra());
    CHECK(!StartPrograms(other).read().empty());
    for (const ExpectedProgram& program : StartPrograms(other).read())
        CHECK(std::filesystem::exists(program.spirv));
}

namespace {

// A glass ball in the light of a lamp: its caustic needs forward rays.
std::string glass_ball() {
    auto scene = nlohmann::json::parse(two_balls);
    scene["materials"][0] = {
        {"extensions", {{"ETD_optics", {{"surface", {{"class", "dielectric"}}}, {"inside", "glass"}}}}}};
    scene["extensions"]["ETD_optics"]["media"] = {
        {{"name", "glass"}, {"class", "homogeneous"}, {"ior", 1.5}}};
    scene["extensions"]["ETD_optics"]["environment"]["radiance"] = 0.01;
    scene["nodes"].push_back(
        {{"translation", {-0.8, 3, 0}}, {"extensions", {{"ETD_optics", {{"light", {{"class", "point"}}}}}}}});
    scene["scenes"][0]["nodes"].push_back(5);
    return scene.dump();
}

bool has_pilot(const Viewed& viewed) {
    return viewed.worker->status().message.find("pilot") != std::string::npos;
}

// Works until the pilot has begun.
void begin_pilot(Viewed& viewed) {
    viewed.request.algorithm = Algorithm::automatic;
    for (int i = 0; i < 100 && !has_pilot(viewed); ++i) viewed.worker->work(viewed.request);
    REQUIRE(has_pilot(viewed));
}

// Works until it is so; false after two minutes.
bool works_until(Viewed& viewed, const std::function<bool()>& is_so) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(2);
    while (!is_so()) {
        if (std::chrono::steady_clock::now() > end) return false;
        if (!viewed.worker->work(viewed.request)) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return true;
}

}  // namespace

TEST_CASE("pictures of a camera that moves go on while a pilot chooses the algorithm") {
    Viewed viewed(glass_ball());
    const auto& status = viewed.worker->status();
    begin_pilot(viewed);
    glm::dmat4 placement = status.receivers[0].placement;
    viewed.request.moving = true;
    int pictures = 0;
    CHECK(works_until(viewed, [&] {
        pictures += viewed.worker->picture()->request == viewed.request;
        placement[3].x += 0.001;
        viewed.request.placement = placement;
        return !has_pilot(viewed);
    }));
    CHECK(pictures >= 10);
    CHECK(status.choice.algorithm == Algorithm::backward);
    viewed.request.moving = false;
    CHECK(works_until(viewed, [&] { return status.choice.algorithm == Algorithm::bidirectional; }));
    CHECK(status.choice.reason.find("pilot") != std::string::npos);
    CHECK(status.message == "");
}

TEST_CASE("what a pilot finds of a scene that is read again meanwhile does not count") {
    Viewed viewed(glass_ball());
    const auto& choice = viewed.worker->status().choice;
    begin_pilot(viewed);
    std::this_thread::sleep_for(std::chrono::milliseconds(300));  // until it has read the scene as it was
    write_text(viewed.folder / "scene.gltf", two_balls);
    for (int i = 0; i < 2; ++i) viewed.worker->reload_changed();
    CHECK(works_until(viewed, [&] {
        return choice.algorithm != Algorithm::backward || choice.reason.find("smooth") != std::string::npos;
    }));
    CHECK(choice.algorithm == Algorithm::backward);
}

TEST_CASE("a step of the mouse breaks off a fine picture, not a coarse one of a view that moves already") {
    PreviewRequest at_rest, moved;
    at_rest.width = 64, at_rest.height = 48;
    moved = at_rest;
    moved.moving = true;
    moved.placement = glm::dmat4(2.0);
    PreviewRequest moved_on = moved, reseeded = moved;
    moved_on.placement = glm::dmat4(3.0);
    reseeded.seed = 1;
    CHECK(at_rest.is_overtaken_by(moved));
    CHECK(!moved.is_overtaken_by(moved_on));
    CHECK(moved.is_overtaken_by(reseeded));
    CHECK(!at_rest.is_overtaken_by(at_rest));
}
