// A receiver that is moved, and images of other sizes, without importing or compiling anything again.
#include <cstring>

#include "host/error.h"
#include "tests/support/render_probe.h"

using namespace etendue;

namespace {

// A ball of ink, a wall with a lamp in front of it, far from the origin; both cameras look along -z.
SceneBuilder room(const Place& camera, double yfov, double ymag) {
    SceneBuilder s;
    s.medium("ink", {{"absorption", {0.2, 0.5, 1.0}}});
    s.rectangle(4, 4, s.lambertian({0.8, 0.5, 0.2}), at(0, 0, -2));
    s.sphere(0.2, s.black_emitter(3), at(0.5, 0.6, -1.2));
    const int ball = s.material({{"surface", {{"class", "dielectric"}}}, {"inside", "ink"}});
    s.sphere(0.7, ball, at(0, 0, 0));
    s.perspective(yfov, camera, "perspective");
    s.orthographic(ymag, camera, "orthographic");
    s.transform({100, -30, 20}, 2);
    return s;
}

std::vector<ExactSum> film(Renderer& renderer) {
    renderer.render_passes(4);
    return renderer.state().pixels;
}

RenderSettings settings_for(const Scene& scene, size_t receiver, Algorithm algorithm) {
    RenderSettings settings;
    settings.width = 24, settings.height = 16;
    settings.receiver = scene.receivers[receiver].ref;
    settings.algorithm = algorithm;
    settings.seed = 7;
    return settings;
}

}  // namespace

TEST_CASE("a receiver that has moved sees what one sees that was there from the start") {
    const Place before = at(0, 0, 2), after = at(0.1, 0.05, 0.2);  // that is in the ink
    Scene scene = compile_test_scene(room(before, 0.6, 1.0).import());
    Scene there = compile_test_scene(room(after, 0.9, 0.4).import());
    for (const Algorithm algorithm : {Algorithm::backward, Algorithm::bidirectional})
        for (size_t receiver = 0; receiver < 2; ++receiver) {
            CAPTURE(receiver);
            const Receiver& wanted = there.receivers[receiver];
            const Receiver first = scene.receivers[receiver];
            Renderer renderer(test_device(), scene, settings_for(scene, receiver, algorithm));
            const std::vector<ExactSum> at_first = film(renderer);
            const size_t compiled = scene.kernels.size();
            move_receiver(scene, receiver, wanted.world_from_local, wanted.parameters);
            renderer.restart(7);
            CHECK(scene.kernels.size() == compiled);
            Renderer expected(test_device(), there, settings_for(there, receiver, algorithm));
            CHECK(film(renderer) == film(expected));
            move_receiver(scene, receiver, first.world_from_local, first.parameters);
            renderer.restart(7);
            CHECK(film(renderer) == at_first);
        }
}

TEST_CASE("a receiver's new parameters are checked like those of a scene file") {
    Scene scene = compile_test_scene(room(at(0, 0, 2), 0.6, 1.0).import());
    const Receiver before = scene.receivers[0];
    const auto message = [&](const glm::dmat4& placement, const nlohmann::json& parameters) {
        try {
            move_receiver(scene, 0, placement, parameters);
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    CHECK(message(before.world_from_local, {{"yfov", 5}}) ==
          "receiver perspective: /yfov: 5 is out of range; allowed: a number in (0, 3.1415926) rad");
    CHECK(message(before.world_from_local, {{"zoom", 5}}) ==
          "receiver perspective: /zoom: unknown parameter of receiver perspective; allowed: yfov");
    CHECK(message(glm::dmat4(0), {{"yfov", 1}}) == "receiver perspective: its placement squashes space flat");
    CHECK(scene.receivers[0].parameters == before.parameters);
    CHECK(scene.receiver_moves == 0);
}

TEST_CASE("an image of another size compiles nothing and shows what a renderer of its own shows") {
    const SceneDescription description = room(at(0, 0, 2), 0.6, 1.0).import();
    for (const Schedule schedule : {Schedule::fused, Schedule::wavefront}) {
        CAPTURE(schedule_name(schedule));
        Scene scene = compile_test_scene(description);
        RenderSettings settings = settings_for(scene, 0, Algorithm::bidirectional);
        settings.schedule = schedule;
        Renderer small(test_device(), scene, settings);
        const std::vector<ExactSum> small_film = film(small);
        const size_t compiled = scene.kernels.size();
        settings.width = 50, settings.height = 20;
        settings.choice = small.choice();
        Renderer large(test_device(), scene, settings);
        CHECK(scene.kernels.size() == compiled);
        Scene alone = compile_test_scene(description);
        Renderer expected(test_device(), alone, settings);
        CHECK(film(large) == film(expected));
        small.restart(7);
        CHECK(film(small) == small_film);
    }
}
