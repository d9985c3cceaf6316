// Real windows, driven by mouse and keys as a user does it.
#include <doctest/doctest.h>

#include "tests/preview/two_balls.h"

using namespace etendue;

TEST_CASE("the window shows the headless image, through every tone curve; panels lie on it") {
    ViewedScene view(two_balls, words_with("480x360"));
    Executable files;  // of the headless image
    write_text(files.folder / "scene.gltf", two_balls);
    const Image image = headless(files, "480x360");
    ViewSettings settings;
    // The panel's ground is dark where the picture is bright.
    CHECK(view.x.wait_until([&](const Screenshot& shot) {
        const uint8_t* ground = shot.at(295, 100);
        return std::max({ground[0], ground[1], ground[2]}) < 60 &&
               greatest_difference(shot, image, settings) > 100;
    }));
    view.x.key("Tab");
    CHECK(shows(view.x, image, settings));
    for (const ToneCurve curve :
         {ToneCurve::aces, ToneCurve::agx, ToneCurve::false_colors, ToneCurve::linear, ToneCurve::srgb}) {
        CAPTURE(tone_curve_name(curve));
        view.x.key("t");
        settings.curve = curve;
        CHECK(shows(view.x, image, settings));
    }
    view.x.key("minus");
    settings.exposure = -1.0 / 3;
    CHECK(shows(view.x, image, settings));
    const Run run = view.close();
    CHECK_MESSAGE(run.code == 0, run.err);
    CHECK(run.err == "");
}

TEST_CASE("drags, the wheel and keys move the camera, and R brings it back") {
    ViewedScene view(two_balls, words_with("320x240"));
    Executable files;
    write_text(files.folder / "scene.gltf", two_balls);
    const Image front = headless(files, "320x240"), side = headless(files, "320x240", "side");
    const ViewSettings settings;
    view.x.key("Tab");
    REQUIRE(shows(view.x, front, settings));
    const Screenshot before = view.x.screenshot();
    const auto changes = [&] {
        return view.x.wait_until([&](const Screenshot& shot) { return changed_share(shot, before) > 0.05; });
    };
    const auto drag = [&](int button) {
        view.x.move(160, 120);
        view.x.button(button, true);
        for (int i = 1; i <= 10; ++i) view.x.move(160 + 6 * i, 120);
        view.x.button(button, false);
    };
    for (const int button : {1, 2, 3}) {  // orbit, pan, look
        CAPTURE(button);
        drag(button);
        CHECK(changes());
        view.x.key("r");
        CHECK(shows(view.x, front, settings));
    }
    view.x.button(4, true), view.x.button(4, false);  // the wheel
    CHECK(changes());
    view.x.key("Home");
    CHECK(shows(view.x, front, settings));
    view.x.button(3, true);  // fly
    view.x.hold("d", true);
    CHECK(changes());
    view.x.hold("d", false);
    view.x.button(3, false);
    view.x.key("r");
    CHECK(shows(view.x, front, settings));
    view.x.key("2");  // the second camera, and back
    CHECK(shows(view.x, side, settings));
    view.x.key("Prior");
    CHECK(shows(view.x, front, settings));
    CHECK(view.close().err == "");
}

TEST_CASE("P draws paths of light over the picture") {
    ViewedScene view(two_balls, words_with("320x240"));
    view.x.key("Tab");
    const Image image = headless_image(two_balls, "320x240");
    REQUIRE(shows(view.x, image, {}));
    const Screenshot before = view.x.screenshot();
    view.x.key("p");
    CHECK(view.x.wait_until([&](const Screenshot& shot) { return changed_share(shot, before) > 0.01; }));
    view.x.key("p");
    CHECK(shows(view.x, image, {}));
    CHECK(view.close().err == "");
}

namespace {

// A window of 640 x 480 pixels, at 96 dpi, with all sections of its panel closed.
struct OpenPanel {
    explicit OpenPanel(const std::string& scene = two_balls, size_t open_at_first = 3)
        : view(scene, words_with("640x480")) {
        REQUIRE(view.x.wait_until(
            [](const Screenshot& shot) { return shot.at(635, 5)[0] > 200 && headers(shot).size() >= 2; }));
        for (size_t i = 0; i < open_at_first; ++i) click(200, headers(view.x.screenshot()).at(i));
        REQUIRE(view.x.wait_until(
            [&](const Screenshot& shot) { return headers(shot).size() == open_at_first + 3; }));
    }
    // Middles of the headers of sections, from the top: bars of one colour across the panel.
    static std::vector<int> headers(const Screenshot& shot) {
        std::vector<int> middles;
        int first = 0;
        for (int y = 30; y < shot.height; ++y) {  // below its title
            const auto is_bar = [&](int at) {
                const uint8_t* c = shot.at(280, at);
                return c[2] > c[0] + 35 && c[2] > c[1] + 15;
            };
            if (is_bar(y) && !is_bar(y - 1)) first = y;
            if (!is_bar(y) && is_bar(y - 1) && y - first > 12) middles.push_back((first + y) / 2);
        }
        return middles;
    }
    void click(int x, int y) {
        view.x.move(x, y);
        std::this_thread::sleep_for(std::chrono::milliseconds(150));
        view.x.press(1);
        std::this_thread::sleep_for(std::chrono::milliseconds(150));
    }
    // Opens one; where its header is.
    int open(size_t section) {
        const int y = headers(view.x.screenshot()).at(section);
        click(200, y);
        return y;
    }
    ViewedScene view;
};
constexpr size_t rays_section = 4, objects_section = 5;
constexpr size_t scene_section = 2;  // where a file offers variants or moves
constexpr int right_of_panel = 320;

double changed_right_of_panel(const Screenshot& a, const Screenshot& b) {
    size_t changed = 0, all = 0;
    for (int y = 0; y < a.height; ++y)
        for (int x = right_of_panel; x < a.width; ++x, ++all)
            for (int c = 0; c < 3; ++c)
                if (std::abs(a.at(x, y)[c] - b.at(x, y)[c]) > 12) {
                    ++changed;
                    break;
                }
    return double(changed) / double(all);
}

}  // namespace

TEST_CASE("the panel chooses the paths that are drawn by what happened to them") {
    OpenPanel panel;
    XServer& x = panel.view.x;
    const int rays = panel.open(rays_section);
    panel.click(60, rays + 134);  // "that were"
    const Screenshot none = x.screenshot();
    x.key("p");
    const auto becomes = [&](const auto& is_right) {
        return x.wait_until(
            [&](const Screenshot& shot) { return is_right(changed_right_of_panel(shot, none)); }, 20);
    };
    REQUIRE(becomes([](double share) { return share > 0.01; }));
    std::this_thread::sleep_for(std::chrono::seconds(1));
    const double all = changed_right_of_panel(x.screenshot(), none);
    const int reflected = rays + 154, refracted = rays + 177;
    panel.click(47, refracted);  // nothing here refracts
    CHECK(becomes([](double share) { return share == 0; }));
    panel.click(47, reflected);  // or that: not those that miss everything
    CHECK(becomes([&](double share) { return share > 0.01 && share < 0.9 * all; }));
    panel.click(47, reflected), panel.click(47, refracted);
    CHECK(becomes([&](double share) { return share > 0.95 * all; }));
    CHECK(panel.view.close().err == "");
}

TEST_CASE("a ball stands where one types it in") {
    OpenPanel panel;
    ViewedScene& view = panel.view;
    const std::string elsewhere = replaced(two_balls, "[-0.8, 0, 0]", "[-0.2, 0, 0]");
    const Image image = headless_image(elsewhere, "640x480");
    const int objects = panel.open(objects_section);
    // Its rows: places, the first of them, and x of its translation, to be typed in.
    panel.click(80, objects + 71), panel.click(100, objects + 88);
    view.x.hold("Control_L", true);
    panel.click(80, objects + 108);
    view.x.hold("Control_L", false);
    for (const char* key : {"minus", "0", "period", "2"}) view.x.key(key);
    view.x.hold("Return", true);  // for some frames, which is how the panels look at keys
    std::this_thread::sleep_for(std::chrono::milliseconds(150));
    view.x.hold("Return", false);
    view.x.move(5, 475);
    view.x.key("Tab");
    CHECK(shows(view.x, image, {}, 0.01));  // another traversal: some edges fall on the other side
    CHECK(view.close().err == "");
}

TEST_CASE("a slider moves through the animations of a file") {
    // The red ball stands at -0.8, at 1 s it jumps to -0.2.
    const std::string moving = replaced(two_balls, R"("cameras":)", R"("animations": [{
"channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}],
"samplers": [{"input": 0, "output": 1, "interpolation": "STEP"}]}],
"buffers": [{"byteLength": 32, "uri": "data:application/octet-stream;base64,AAAAAAAAgD/NzEy/AAAAAAAAAADNzEy+AAAAAAAAAAA="}],
"bufferViews": [{"buffer": 0, "byteLength": 8}, {"buffer": 0, "byteOffset": 8, "byteLength": 24}],
"accessors": [{"bufferView": 0, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [1]},
              {"bufferView": 1, "componentType": 5126, "count": 2, "type": "VEC3"}],
"cameras":)");
    const Image first = headless_image(two_balls, "640x480"),
                last = headless_image(replaced(two_balls, "[-0.8, 0, 0]", "[-0.2, 0, 0]"), "640x480");
    OpenPanel panel(moving, 4);
    XServer& x = panel.view.x;
    const int scene = panel.open(scene_section);
    panel.click(20, scene + 24);  // "animated"
    const auto drag = [&](int from, int to) {
        x.move(from, scene + 47);
        std::this_thread::sleep_for(std::chrono::milliseconds(150));
        x.button(1, true);
        std::this_thread::sleep_for(std::chrono::milliseconds(150));
        x.move(to, scene + 47);
        std::this_thread::sleep_for(std::chrono::milliseconds(150));
        x.button(1, false);
        x.move(5, 475);
    };
    const auto shows_without_panel = [&](const Image& image) {
        x.key("Tab");
        const bool shown = shows(x, image, {}, 0.01);  // edges, as below
        x.key("Tab");
        return shown;
    };
    drag(30, 300);
    CHECK(shows_without_panel(last));
    drag(170, 60);
    CHECK(shows_without_panel(first));
    CHECK(panel.view.close().err == "");
}

TEST_CASE("the question mark lists the keys") {
    ViewedScene view(two_balls, words_with("800x600"));
    view.x.key("Tab");
    Executable files;
    write_text(files.folder / "scene.gltf", two_balls);
    const Image image = headless(files, "800x600");
    REQUIRE(shows(view.x, image, {}));
    const Screenshot before = view.x.screenshot();
    view.x.key("slash", true);
    CHECK(view.x.wait_until([&](const Screenshot& shot) { return changed_share(shot, before) > 0.2; }));
    view.x.key("slash", true);
    CHECK(shows(view.x, image, {}));
    CHECK(view.close().err == "");
}

TEST_CASE("without a display, a driver, the module or a good scene there is one line") {
    Executable program;
    write_text(program.folder / "scene.gltf", two_balls);
    program.environment["DISPLAY"] = ":9999";
    Run run = program.run({"view", "scene.gltf"});
    CHECK(run.code == 3);
    CHECK(run.error_lines() == 1);
    CHECK(run.err.find("no window can be opened") != std::string::npos);

    std::filesystem::copy_file(Executable::path(), program.folder / "etendue");
    const std::string alone = (program.folder / "etendue").string();
    const std::string command =
        "cd " + program.folder.path.string() + " && ./etendue view scene.gltf 2>alone.txt";
    const int status = std::system(command.c_str());
    CHECK(WEXITSTATUS(status) == 3);
    const std::string line = read_text(program.folder / "alone.txt");
    CHECK(std::count(line.begin(), line.end(), '\n') == 1);
    CHECK(line.find("the window cannot be loaded") != std::string::npos);

    XServer x;
    program.environment["DISPLAY"] = x.name();
    program.environment["VK_DRIVER_FILES"] = program.environment["VK_ICD_FILENAMES"] = "/dev/null";
    run = program.run({"view", "scene.gltf"});
    CHECK(run.code == 3);
    CHECK(run.error_lines() == 1);
    program.environment.erase("VK_DRIVER_FILES");
    program.environment.erase("VK_ICD_FILENAMES");
    run = program.run({"view", "none.gltf"});
    CHECK(run.code == 2);
    CHECK(run.error_lines() == 1);
}

TEST_CASE("the executable itself needs no window library") {
    TemporaryFolder folder;
    const std::string list = (folder / "libraries.txt").string();
    REQUIRE(std::system(("ldd " + Executable::path() + " >" + list).c_str()) == 0);
    const std::string libraries = read_text(list);
    CHECK(libraries.find("libvulkan") != std::string::npos);
    for (const char* name : {"glfw", "imgui", "libX", "xcb", "wayland"}) {
        CAPTURE(name);
        CHECK(libraries.find(name) == std::string::npos);
    }
}
