// Every key and drag that the window lists does what the list says.
#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "host/preview/window/shortcuts.h"
#include "tests/preview/two_balls.h"

using namespace etendue;

namespace {

constexpr int width = 320, height = 240;
const std::string size = "320x240";
constexpr double notice_share = 0.1;  // of the pixels lies under what is said below

struct Pose {
    glm::dmat4 placement;
    glm::dvec3 eye() const { return glm::dvec3(placement[3]); }
    glm::dvec3 right() const { return glm::normalize(glm::dvec3(placement[0])); }
    glm::dvec3 up() const { return glm::normalize(glm::dvec3(placement[1])); }
    glm::dvec3 axis() const { return -glm::normalize(glm::dvec3(placement[2])); }
    glm::dvec3 seen(const glm::dvec3& point) const {  // in the camera's coordinates
        return glm::dvec3(glm::inverse(placement) * glm::dvec4(point, 1));
    }
};
bool same(const glm::dvec3& a, const glm::dvec3& b) { return glm::length(a - b) < 1e-6; }

Pose pose_of(const nlohmann::json& gltf) {
    const auto matrix = gltf.at("nodes").at(0).at("matrix").get<std::vector<double>>();
    REQUIRE(matrix.size() == 16);
    Pose pose;
    for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r) pose.placement[c][r] = matrix[size_t(4 * c + r)];
    return pose;
}

// A window that shows the two balls without panels, and what its camera looks like.
struct Shown : ViewedScene {
    Shown() : ViewedScene(two_balls, words_with(size)) {
        write_text(files.folder / "scene.gltf", two_balls);
        front = headless(files, size), side = headless(files, size, "side");
        x.key("Tab");
        REQUIRE(shows(x, front, {}));
    }
    nlohmann::json copied_camera() {
        return nlohmann::json::parse(x.copied([&] { x.key("c"); }));
    }
    Pose pose() { return pose_of(copied_camera()); }
    // What `change` does to the camera.
    std::pair<Pose, Pose> before_and_after(const std::function<void()>& change) {
        const Pose before = pose();
        change();
        return {before, pose()};
    }
    void drag(int button, const char* held = nullptr) {
        if (held) x.hold(held, true);
        x.move(250, 60);
        x.button(button, true);
        for (int i = 1; i <= 5; ++i) x.move(250 - 8 * i, 60 + 4 * i);
        x.button(button, false);
        if (held) x.hold(held, false);
    }
    // The key is held for some time, the camera looking around.
    void fly(const char* key, const char* with = nullptr, int milliseconds = 300) {
        x.move(160, 120);
        x.button(3, true);
        if (with) x.hold(with, true);
        x.hold(key, true);
        std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
        x.hold(key, false);
        if (with) x.hold(with, false);
        x.button(3, false);
    }
    void wait_until_changed(const Screenshot& from, double share) {
        CHECK(x.wait_until([&](const Screenshot& shot) { return changed_share(shot, from) > share; }));
    }
    Executable files;
    Image front, side;
};

void check_turns_around(Shown& view, const glm::dvec3& center, double radius, int pixel_x, int pixel_y,
                        const std::function<void()>& choose) {
    // Where the camera's ray through the pixel meets the ball.
    const Pose before = view.pose();
    const double tangent = std::tan(0.6 / 2), u = (2 * (pixel_x + 0.0) - width) / height * tangent,
                 v = (1 - 2 * (pixel_y + 0.0) / height) * tangent;
    const glm::dvec3 direction = glm::normalize(u * before.right() + v * before.up() + before.axis());
    const glm::dvec3 to_center = center - before.eye();
    const double along = glm::dot(to_center, direction), off = glm::dot(to_center, to_center) - along * along;
    REQUIRE(off < radius * radius);
    const glm::dvec3 point = before.eye() + (along - std::sqrt(radius * radius - off)) * direction;

    view.x.move(pixel_x, pixel_y);
    choose();
    view.pose();  // takes its turn behind it
    view.drag(1);
    const Pose after = view.pose();
    CHECK(glm::length(after.eye() - before.eye()) > 0.1);
    CHECK(glm::length(after.seen(point) - before.seen(point)) < 1e-4);
    view.x.key("r");
    CHECK(same(view.pose().eye(), before.eye()));
}

// By the keys as they are listed.
const std::map<std::string, std::function<void(Shown&)>> checks = {
    {"left drag",
     [](Shown& view) {
         const auto [a, b] = view.before_and_after([&] { view.drag(1); });
         // Around a point that both axes go through; the camera rises where the pointer is drawn down.
         const glm::dvec3 normal = glm::normalize(glm::cross(a.axis(), b.axis()));
         CHECK(std::abs(glm::dot(normal, b.eye() - a.eye())) < 1e-6);
         CHECK(glm::dot(a.right(), b.eye() - a.eye()) > 0.1);
         CHECK(b.eye().y > a.eye().y + 0.1);
     }},
    {"middle drag, Shift + left drag",
     [](Shown& view) {
         for (const bool middle : {true, false}) {
             const auto [a, b] =
                 view.before_and_after([&] { view.drag(middle ? 2 : 1, middle ? nullptr : "Shift_L"); });
             CHECK(same(a.axis(), b.axis()));
             CHECK(std::abs(glm::dot(a.axis(), b.eye() - a.eye())) < 1e-6);
             CHECK(glm::dot(a.right(), b.eye() - a.eye()) > 0.05);
             CHECK(glm::dot(a.up(), b.eye() - a.eye()) > 0.03);
         }
     }},
    {"wheel, Ctrl + left drag",
     [](Shown& view) {
         for (const bool wheel : {true, false}) {
             const auto [a, b] =
                 view.before_and_after([&] { wheel ? view.x.press(4) : view.drag(1, "Control_L"); });
             CHECK(same(a.axis(), b.axis()));
             const double nearer = glm::dot(a.axis(), b.eye() - a.eye());
             CHECK((wheel ? nearer : -nearer) > 0.1);
             CHECK(same(b.eye(), a.eye() + nearer * a.axis()));
         }
         const auto [a, b] = view.before_and_after([&] { view.x.press(5); });
         CHECK(glm::dot(a.axis(), b.eye() - a.eye()) < -0.1);
     }},
    {"right drag",
     [](Shown& view) {
         const auto [a, b] = view.before_and_after([&] { view.drag(3); });
         CHECK(same(a.eye(), b.eye()));
         CHECK(glm::dot(a.right(), b.axis()) > 0.05);  // what is seen follows the pointer
         CHECK(b.axis().y > a.axis().y + 0.05);
         struct {
             const char* key;
             glm::dvec3 way;
         } const ways[] = {{"w", {0, 0, 1}}, {"s", {0, 0, -1}}, {"a", {-1, 0, 0}},
                           {"d", {1, 0, 0}}, {"q", {0, -1, 0}}, {"e", {0, 1, 0}}};
         for (const auto& [key, way] : ways) {
             CAPTURE(key);
             const auto [from, to] = view.before_and_after([&, name = key] { view.fly(name); });
             const glm::dvec3 step = way.x * from.right() + way.y * from.up() + way.z * from.axis();
             const double metres = glm::dot(step, to.eye() - from.eye());
             CHECK(metres > 0.05);
             CHECK(same(to.eye(), from.eye() + metres * step));
             CHECK(same(to.axis(), from.axis()));
         }
         const auto flown = [&](const char* with) {
             const auto [from, to] = view.before_and_after([&] { view.fly("w", with); });
             return glm::length(to.eye() - from.eye());
         };
         const double fast = flown("Shift_L"), usual = flown(nullptr), slow = flown("Control_L");
         CHECK(fast > 2 * usual);
         CHECK(usual > 2 * slow);
         CHECK(slow > 0);
     }},
    {"F, double click",
     [](Shown& view) {
         check_turns_around(view, {-0.8, 0, 0}, 0.6, 97, 150, [&] { view.x.key("f"); });
         check_turns_around(view, {0.8, 0.2, -1}, 0.8, 205, 128, [&] { view.x.press(1), view.x.press(1); });
         // Two drags, one shortly after the other, are no double click: the point stays the scene's centre.
         view.x.move(97, 150);
         const Pose a = view.pose();
         view.drag(1), view.drag(1);
         const Pose b = view.pose();
         CHECK(std::abs(glm::dot(glm::cross(a.axis(), b.axis()), b.eye() - a.eye())) < 1e-6);
     }},
    {"R, Home",
     [](Shown& view) {
         for (const char* key : {"r", "Home"}) {
             CAPTURE(key);
             const Screenshot shot = view.x.screenshot();
             view.drag(1);
             view.wait_until_changed(shot, 0.1);
             view.x.key(key);
             CHECK(shows(view.x, view.front, {}, notice_share));
         }
     }},
    {"1 to 9, Page Up, Page Down",
     [](Shown& view) {
         view.x.key("2");
         CHECK(shows(view.x, view.side, {}, notice_share));
         view.x.key("9");  // there is none
         view.x.key("1");
         CHECK(shows(view.x, view.front, {}, notice_share));
         view.x.key("Next");
         CHECK(shows(view.x, view.side, {}, notice_share));
         view.x.key("Prior");
         CHECK(shows(view.x, view.front, {}, notice_share));
         view.x.key("Prior");  // around
         CHECK(shows(view.x, view.side, {}, notice_share));
         view.x.key("Next");
     }},
    {"L",
     [](Shown& view) {
         const auto pixel = [&](int px, int py, const glm::ivec3& color) {
             CHECK(view.x.wait_until([&](const Screenshot& shot) {
                 const uint8_t* c = shot.at(px, py);
                 return std::abs(c[0] - color.x) + std::abs(c[1] - color.y) + std::abs(c[2] - color.z) < 24;
             }));
         };
         const Screenshot shot = view.x.screenshot();
         view.x.key("l");  // errors, in false colours
         view.wait_until_changed(shot, 0.5);
         view.x.key("l");  // albedo of the red ball
         pixel(97, 150, {204, 26, 26});
         view.x.key("l");  // where its normal points to the camera
         pixel(98, 159, {147, 140, 252});
         view.x.key("l");  // depth: the surroundings are black
         pixel(10, 10, {0, 0, 0});
         view.x.key("l");
         CHECK(shows(view.x, view.front, {}));
     }},
    {"T",
     [](Shown& view) {
         ViewSettings settings;
         for (const ToneCurve curve : {ToneCurve::aces, ToneCurve::agx, ToneCurve::false_colors,
                                       ToneCurve::linear, ToneCurve::srgb}) {
             CAPTURE(tone_curve_name(curve));
             view.x.key("t");
             settings.curve = curve;
             CHECK(shows(view.x, view.front, settings));
         }
     }},
    {"+, -",
     [](Shown& view) {
         ViewSettings settings;
         view.x.key("equal", true);
         settings.exposure = 1.0 / 3;
         CHECK(shows(view.x, view.front, settings));
         view.x.key("minus"), view.x.key("minus");
         settings.exposure = -1.0 / 3;
         CHECK(shows(view.x, view.front, settings));
         view.x.key("equal", true);
     }},
    {"0",
     [](Shown& view) {
         view.x.key("minus");
         ViewSettings settings;
         settings.exposure = -1.0 / 3;
         REQUIRE(shows(view.x, view.front, settings));
         view.x.key("0");
         CHECK(shows(view.x, view.front, {}));
     }},
    {"M",
     [](Shown& view) {
         std::vector<glm::vec3> radiance(pixel_count(view.front));
         const auto channels = picture_channels(view.front);
         for (size_t c = 0; c < 3; ++c)
             for (size_t i = 0; i < radiance.size(); ++i)
                 radiance[i][int(c)] = plane(view.front, channels[c])[i];
         ViewSettings settings;
         settings.exposure = metered_exposure(radiance);
         REQUIRE(settings.exposure < -1);
         view.x.key("m");
         CHECK(shows(view.x, view.front, settings));
         view.x.key("0");
     }},
    {"P",
     [](Shown& view) {
         const Screenshot shot = view.x.screenshot();
         view.x.key("p");
         view.wait_until_changed(shot, 0.01);
         view.x.key("p");
         CHECK(shows(view.x, view.front, {}));
     }},
    {"Space",
     [](Shown& view) {
         const Screenshot shot = view.x.screenshot();
         view.x.key("space");
         view.x.key("2");  // a coarse picture of what has changed, and no more
         view.wait_until_changed(shot, 0.1);
         CHECK(!view.x.wait_until(
             [&](const Screenshot& now) {
                 return greatest_difference(now, view.side, {}, notice_share) < rounding;
             },
             1));
         view.x.key("space");
         CHECK(shows(view.x, view.side, {}, notice_share));
         view.x.key("1");
     }},
    {"C",
     [](Shown& view) {
         for (const bool parallel : {false, true}) {
             CAPTURE(parallel);
             if (parallel) view.x.key("2");
             view.drag(1), view.x.press(4);
             nlohmann::json camera = view.copied_camera(), scene = nlohmann::json::parse(two_balls);
             CHECK(camera["cameras"][0]["type"] == (parallel ? "orthographic" : "perspective"));
             camera["nodes"][0]["name"] = "copied";
             camera["nodes"][0]["camera"] = scene["cameras"].size();
             scene["scenes"][0]["nodes"].push_back(scene["nodes"].size());
             scene["cameras"].push_back(camera["cameras"][0]);
             scene["nodes"].push_back(camera["nodes"][0]);
             Executable files;
             write_text(files.folder / "scene.gltf", scene.dump());
             CHECK(shows(view.x, headless(files, size, "copied"), {}, notice_share));
             view.x.key("r");
         }
         view.x.key("1");
     }},
    {"Ctrl + S",
     [](Shown& view) {
         const std::filesystem::path exr = view.program.folder / "scene-001.exr",
                                     png = view.program.folder / "scene-001.png";
         REQUIRE(!std::filesystem::exists(exr));
         view.x.key("s");  // nothing
         view.x.hold("Control_L", true);
         view.x.key("s");
         view.x.hold("Control_L", false);
         CHECK(view.x.wait_until([&](const Screenshot&) { return std::filesystem::exists(png); }));
         CHECK(std::filesystem::exists(exr));
         CHECK(!std::filesystem::exists(view.program.folder / "scene-002.exr"));
     }},
    {"Tab",
     [](Shown& view) {
         view.x.key("Tab");
         CHECK(view.x.wait_until([](const Screenshot& shot) { return shot.at(295, 100)[2] < 60; }));
         view.x.key("Tab");
         CHECK(shows(view.x, view.front, {}));
     }},
    {"?, F1",
     [](Shown& view) {
         const Screenshot shot = view.x.screenshot();
         for (const bool question : {true, false}) {
             view.x.key(question ? "slash" : "F1", question);
             view.wait_until_changed(shot, 0.5);
             view.x.key(question ? "slash" : "F1", question);
             CHECK(shows(view.x, view.front, {}));
         }
     }},
    {"Esc",
     [](Shown& view) {
         const Screenshot shot = view.x.screenshot();
         view.x.key("F1");
         view.wait_until_changed(shot, 0.5);
         view.x.key("Escape");
         CHECK(shows(view.x, view.front, {}));
         const Run run = view.close();
         CHECK(run.code == 0);
         CHECK(run.err == "");
     }},
};

}  // namespace

TEST_CASE("every key that is listed does what the list says") {
    Shown view;
    for (const Shortcut& shortcut : shortcuts) {
        const std::string keys = shortcut.keys;
        CAPTURE(keys);
        const auto check = checks.find(keys);
        REQUIRE_MESSAGE(check != checks.end(), "no check");
        check->second(view);
        if (view.process < 0) break;  // the last one closes the window
        view.x.move(5, 5);
        view.x.key("r");
    }
}
