// The module that `etendue view` loads: a window, until it is closed.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_vulkan.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <utility>

#include "host/error.h"
#include "host/image/atomic_file.h"
#include "host/interrupt.h"
#include "host/preview/view_module.h"
#include "host/preview/window/font.h"
#include "host/preview/window/input.h"
#include "host/preview/window/panels.h"
#include "host/preview/window/presenter.h"

namespace etendue {
namespace {

constexpr double frame_seconds = 1.0 / 60, moving_frame_seconds = 0.04, moving_seconds = 0.2,
                 idle_seconds = 0.5;
constexpr int frames_after_events = 3;  // until panels have settled
constexpr int default_rows = 720;

struct Glfw {
    Glfw() {
        glfwSetErrorCallback([](int, const char* text) { last_error() = text; });
        if (!glfwInit()) fail_device("no window can be opened: {}", last_error());
        if (!glfwVulkanSupported()) fail_device("no window can be opened: no Vulkan driver shows pictures");
    }
    ~Glfw() { glfwTerminate(); }
    static std::string& last_error() {
        static std::string text = "no display";
        return text;
    }
};

// Wakes the window, while there is one.
class Bell {
  public:
    void ring() {
        const std::lock_guard lock(mutex_);
        if (is_on_) glfwPostEmptyEvent();
    }
    void set(bool on) {
        const std::lock_guard lock(mutex_);
        is_on_ = on;
    }

  private:
    std::mutex mutex_;
    bool is_on_ = false;
};
struct BellOn {
    explicit BellOn(Bell& bell) : bell(bell) { bell.set(true); }
    ~BellOn() { bell.set(false); }
    Bell& bell;
};

struct Panels {
    Panels(GLFWwindow* window, float scale) {
        ImGui::CreateContext();
        ImGuiIO& io = ImGui::GetIO();
        io.IniFilename = nullptr;
        load_font(scale);
        ImGui::StyleColorsDark();
        ImGui::GetStyle().ScaleAllSizes(scale);
        ImGui_ImplGlfw_InitForVulkan(window, true);
    }
    ~Panels() {
        ImGui_ImplGlfw_Shutdown();
        ImGui::DestroyContext();
    }
};

GLFWwindow* open_window(const ViewOptions& options) {
    int width = 0, height = 0;
    if (options.size) {
        width = int(options.size->width), height = int(options.size->height);
    } else {
        height = default_rows, width = height * 16 / 9;
    }
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    const std::string title = "étendue: " + options.scene.filename().string();
    GLFWwindow* window = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
    if (!window) fail_device("no window can be opened: {}", Glfw::last_error());
    return window;
}

// The picture and the panels on the screen, by another presenter whenever the device or the surface is lost.
class Screen {
  public:
    explicit Screen(ViewState& state) : state_(state) { open(); }
    void resized() { presenter_->resized(); }
    // Letters and panels for another display than before.
    void rescale(float by) {
        load_font(state_.content_scale);
        ImGui::GetStyle().ScaleAllSizes(by);
        open();
    }
    uint64_t device_bytes() const { return presenter_->device_bytes(); }
    uint32_t devices_lost() const { return devices_lost_; }
    const std::shared_ptr<const PreviewPicture>& developed() const { return developed_; }
    // False: the frame could not be shown; it is to be drawn again.
    bool draw() {
        try {
            develop();
            const bool drawn = presenter_->draw(ImGui::GetDrawData());
            has_drawn_ |= drawn;
            return drawn;
        } catch (const DeviceLost&) {
            if (!has_drawn_) throw;  // nor will another one
            ++devices_lost_;
            open();
            return false;
        }
    }

  private:
    void open() {
        presenter_.reset();
        presenter_ = std::make_unique<Presenter>(state_.window, state_.options.shaders);
        developed_.reset();
        has_drawn_ = false;
    }
    void develop() {
        if (!state_.picture) return;
        const ViewTransform view = view_transform(shown_settings(state_));
        if (state_.picture == developed_ && view == developed_as_) return;
        presenter_->develop(*state_.picture, view);
        developed_ = state_.picture;
        developed_as_ = view;
    }
    ViewState& state_;
    std::unique_ptr<Presenter> presenter_;
    std::shared_ptr<const PreviewPicture> developed_;
    ViewTransform developed_as_{};
    bool has_drawn_ = false;  // the presenter at hand, a frame
    uint32_t devices_lost_ = 0;
};

// What the window shows when nothing has been asked for yet, and what the session is told once a frame.
void tell_session(ViewState& state) {
    int width = 0, height = 0;
    glfwGetFramebufferSize(state.window, &width, &height);
    const bool hidden = glfwGetWindowAttrib(state.window, GLFW_ICONIFIED);
    state.request.width = hidden ? 0 : uint32_t(width);
    state.request.height = hidden ? 0 : uint32_t(height);
    state.request.moving = glfwGetTime() - state.moved_at < moving_seconds;
    state.request.wants_depth = state.rays.on && state.rays.faint_behind;
    state.request.placement = state.moved ? std::optional(state.pose.placement) : std::nullopt;
    state.session.request(state.request);
}

void write_view_stats(const ViewState& state, const Screen& screen) {
    if (state.options.stats.empty()) return;
    const nlohmann::json stats = {{"first_picture_seconds", state.first_shown},
                                  {"longest_frame_seconds", state.longest_frame},
                                  {"longest_seconds_between_moving_frames", state.longest_between_frames},
                                  {"longest_seconds_between_moving_pictures", state.longest_between_pictures},
                                  {"passes", state.status.passes},
                                  {"step", state.status.step},
                                  {"device_bytes", state.status.device_bytes},
                                  {"window_device_bytes", screen.device_bytes()},
                                  {"devices_lost", state.status.devices_lost},
                                  {"window_devices_lost", screen.devices_lost()}};
    const std::string text = stats.dump(2) + "\n";
    write_atomically(state.options.stats, text);
}

void show_until_closed(ViewState& state, Input& input, Screen& screen) {
    float scale = state.content_scale;  // that letters and panels are made for
    bool moved = false;                 // the view, in the frame before
    double last_picture = 0;            // while the view moves; 0 = it stood still
    int frames_left = frames_after_events;
    double last_frame = 0;
    while (!glfwWindowShouldClose(state.window) && !interrupted()) {
        // Frames without a picture would only delay the first one.
        const bool waits = last_frame > 0 && !state.picture && state.status.question.empty();
        const double now = glfwGetTime(), next = last_frame + (waits ? idle_seconds : frame_seconds);
        if (frames_left > 0 && next > now)
            glfwWaitEventsTimeout(next - now);
        else if (frames_left > 0)
            glfwPollEvents();
        else
            glfwWaitEventsTimeout(state.request.moving ? moving_frame_seconds : idle_seconds);
        const double start = glfwGetTime();
        const bool news = receive_news(state);
        const bool flies = input.fly_on(start - last_frame);
        tell_session(state);
        if (state.request.width == 0) {
            frames_left = 0;
            continue;
        }
        if (input.take_resize()) screen.resized();
        // While the view is dragged only pictures are new: frames without one would take time from the
        // renderer.
        const bool events = input.take_events();
        if (input.drags() && !flies)
            frames_left = news ? 1 : frames_left;
        else if (events || news || flies)
            frames_left = frames_after_events;
        // What stands for some time: messages end, movement comes to rest.
        const bool stirs = start - state.notice_at < 5 || start - state.moved_at < 2 * moving_seconds;
        if (stirs && start - last_frame > moving_frame_seconds) frames_left = std::max(frames_left, 1);
        const bool is_first = waits && state.picture;
        if (frames_left == 0 || (start < next && !is_first)) continue;
        --frames_left;

        if (state.content_scale != scale)  // moved to another display
            screen.rescale(state.content_scale / std::exchange(scale, state.content_scale));
        ImGui_ImplVulkan_NewFrame();
        ImGui_ImplGlfw_NewFrame();
        ImGui::NewFrame();
        draw_panels(state);
        ImGui::Render();
        if (state.picture) {
            if (!state.request.moving)
                last_picture = 0;
            else if (state.picture != screen.developed() || last_picture == 0) {
                if (last_picture > 0)
                    state.longest_between_pictures =
                        std::max(state.longest_between_pictures, start - last_picture);
                last_picture = start;
            }
        }
        if (!screen.draw()) frames_left = std::max(frames_left, 1);
        if (state.picture && state.first_shown == 0) state.first_shown = seconds_since_start();
        if (state.first_shown > 0) state.longest_frame = std::max(state.longest_frame, glfwGetTime() - start);
        if (state.request.moving && moved)
            state.longest_between_frames = std::max(state.longest_between_frames, start - last_frame);
        moved = state.request.moving;
        last_frame = start;
    }
}

}  // namespace

int run_view(const ViewOptions& options) {
    Bell bell;
    PreviewSession session(options, [&] { bell.ring(); });  // opens the scene while the window opens
    const Glfw glfw;
    const BellOn bell_on(bell);
    std::unique_ptr<GLFWwindow, void (*)(GLFWwindow*)> window(open_window(options), glfwDestroyWindow);
    ViewState state(options, session);
    state.window = window.get();
    state.view.curve = options.curve;
    state.view.exposure = options.exposure.value_or(0);
    if (options.exposure) state.metering.stop();
    state.request.algorithm = options.algorithm;
    state.request.seed = uint32_t(options.seed ^ (options.seed >> 32));
    glfwGetWindowContentScale(state.window, &state.content_scale, nullptr);
    tell_session(state);
    Input input(state);
    const Panels panels(state.window, state.content_scale);
    try {
        Screen screen(state);
        show_until_closed(state, input, screen);
        write_view_stats(state, screen);
    } catch (const Error& error) {
        if (error.code != ExitCode::device_failed) throw;
        const std::string kept = rescue_picture(state);
        if (kept.empty()) throw;
        fail_device("{}; the last picture is in {}", error.what(), kept);
    }
    return int(ExitCode::done);
}

}  // namespace etendue

extern "C" int etendue_view(const etendue::ViewOptions& options) { return etendue::run_view(options); }
