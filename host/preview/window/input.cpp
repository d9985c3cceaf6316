#include "host/preview/window/input.h"

#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace etendue {
namespace {

constexpr double double_click_seconds = 0.3;
constexpr double double_click_distance = 4;  // between the two, in the window's coordinates
constexpr double wheel_factor = 0.9;         // of the distance, a notch
constexpr double dragged_powers = 4;         // of e of the distance, for the window's height
constexpr double radii_a_second = 0.5;       // flying: of the scene
constexpr double fast = 4, slow = 0.25;      // with Shift and Ctrl

Input& of(GLFWwindow* window) { return *static_cast<Input*>(glfwGetWindowUserPointer(window)); }

}  // namespace

Input::Input(ViewState& state) : state_(state) {
    GLFWwindow* window = state.window;
    glfwSetWindowUserPointer(window, this);
    glfwSetKeyCallback(window, [](GLFWwindow* w, int key, int, int action, int mods) {
        of(w).events_ = true;
        if (!ImGui::GetIO().WantTextInput) of(w).on_key(key, action, mods);
    });
    glfwSetCharCallback(window, [](GLFWwindow* w, unsigned character) {
        of(w).events_ = true;
        if (ImGui::GetIO().WantTextInput) return;
        ViewState& state = of(w).state_;  // by character: where they stand depends on the keyboard
        if (character == '?') state.help = !state.help;
        if (character == '+' || character == '-') state.view.exposure += (character == '+' ? 1.0 : -1.0) / 3;
    });
    glfwSetMouseButtonCallback(window, [](GLFWwindow* w, int button, int action, int mods) {
        of(w).events_ = true;
        of(w).on_button(button, action, mods);
    });
    glfwSetCursorPosCallback(window, [](GLFWwindow* w, double x, double y) {
        of(w).events_ = true;
        of(w).on_move(x, y);
    });
    glfwSetScrollCallback(window, [](GLFWwindow* w, double, double y) {
        of(w).events_ = true;
        if (!ImGui::GetIO().WantCaptureMouse) of(w).on_scroll(y);
    });
    glfwSetFramebufferSizeCallback(window,
                                   [](GLFWwindow* w, int, int) { of(w).resized_ = of(w).events_ = true; });
    glfwSetWindowRefreshCallback(window, [](GLFWwindow* w) { of(w).events_ = true; });
    glfwSetWindowIconifyCallback(window, [](GLFWwindow* w, int) { of(w).events_ = true; });
    glfwSetWindowFocusCallback(window, [](GLFWwindow* w, int) { of(w).events_ = true; });
    glfwSetWindowContentScaleCallback(window, [](GLFWwindow* w, float x, float) {
        of(w).state_.content_scale = x;
        of(w).events_ = true;
    });
}

bool Input::take_events() { return std::exchange(events_, false); }
bool Input::take_resize() { return std::exchange(resized_, false); }

void Input::on_key(int key, int action, int mods) {
    if (action == GLFW_RELEASE) return;
    ViewState& s = state_;
    const int receivers = int(s.status.receivers.size());
    const auto step_receiver = [&](int by) {
        if (receivers > 0)
            choose_receiver(s, uint32_t((int(s.request.receiver) + by + receivers) % receivers));
    };
    if (key >= GLFW_KEY_1 && key <= GLFW_KEY_9 && mods == 0) {
        if (key - GLFW_KEY_1 < receivers) choose_receiver(s, uint32_t(key - GLFW_KEY_1));
        return;
    }
    if (!s.status.question.empty() && (key == GLFW_KEY_Y || key == GLFW_KEY_N))
        return s.session.answer(key == GLFW_KEY_Y);
    const bool flies = drag_ == Drag::look;
    switch (key) {
        case GLFW_KEY_PAGE_UP:
            return step_receiver(-1);
        case GLFW_KEY_PAGE_DOWN:
            return step_receiver(1);
        case GLFW_KEY_F1:
            s.help = !s.help;
            return;
        case GLFW_KEY_ESCAPE:
            if (!std::exchange(s.help, false)) glfwSetWindowShouldClose(s.window, GLFW_TRUE);
            return;
        case GLFW_KEY_TAB:
            s.panels = !s.panels;
            return;
        case GLFW_KEY_P:
            s.rays.on = !s.rays.on;
            if (s.rays.on) trace_paths(s);
            return;
        case GLFW_KEY_SPACE:
            s.request.paused = !s.request.paused;
            return;
        case GLFW_KEY_HOME:
        case GLFW_KEY_R:
            return reset_camera(s);
        case GLFW_KEY_F:
            return focus_at_pointer(s);
        case GLFW_KEY_M:
            return meter_exposure(s);
        case GLFW_KEY_0:
            s.view.exposure = 0;
            return;
        case GLFW_KEY_T:
            s.view.curve = ToneCurve((int(s.view.curve) + 1) % 5);
            return;
        case GLFW_KEY_L:
            s.request.layer = Layer((int(s.request.layer) + 1) % 5);
            return;
        case GLFW_KEY_C:
            return copy_camera(s);
        case GLFW_KEY_S:
            if ((mods & GLFW_MOD_CONTROL) && !flies) save_image(s);
            return;
        default:
            return;
    }
}

void Input::on_button(int button, int action, int mods) {
    if (action == GLFW_RELEASE) {
        drag_ = Drag::none;
        return;
    }
    if (ImGui::GetIO().WantCaptureMouse) return;
    if (button == GLFW_MOUSE_BUTTON_LEFT) {
        drag_ = mods & GLFW_MOD_SHIFT ? Drag::pan : mods & GLFW_MOD_CONTROL ? Drag::dolly : Drag::orbit;
        const double now = glfwGetTime();
        const bool again = now - std::exchange(clicked_at_, now) < double_click_seconds;
        const double moved =
            std::hypot(x_ - std::exchange(clicked_x_, x_), y_ - std::exchange(clicked_y_, y_));
        if (again && moved <= double_click_distance) focus_at_pointer(state_);
    }
    if (button == GLFW_MOUSE_BUTTON_MIDDLE) drag_ = Drag::pan;
    if (button == GLFW_MOUSE_BUTTON_RIGHT) drag_ = Drag::look;
}

void Input::on_move(double x, double y) {
    int width = 1, height = 1, pixels_x = 1, pixels_y = 1;
    glfwGetWindowSize(state_.window, &width, &height);
    glfwGetFramebufferSize(state_.window, &pixels_x, &pixels_y);
    const double right = (x - std::exchange(x_, x)) / std::max(height, 1),
                 down = (y - std::exchange(y_, y)) / std::max(height, 1);
    state_.pointer_x = x * pixels_x / std::max(width, 1),
    state_.pointer_y = y * pixels_y / std::max(height, 1);
    const PreviewReceiver* receiver = shown_receiver(state_);
    if (drag_ == Drag::none || !receiver) return;
    constexpr double half_turn = std::numbers::pi;
    if (drag_ == Drag::orbit)
        move_camera(state_, orbit(state_.pose, half_turn * right, half_turn * down));
    else if (drag_ == Drag::pan)
        move_camera(state_, pan(state_.pose, receiver->lens, right, down));
    else if (drag_ == Drag::dolly)
        move_camera(state_, dolly(state_.pose, receiver->lens, std::exp(dragged_powers * down)));
    else
        move_camera(state_, look(state_.pose, -right, -down));
}

void Input::on_scroll(double amount) {
    if (const PreviewReceiver* receiver = shown_receiver(state_))
        move_camera(state_, dolly(state_.pose, receiver->lens, std::pow(wheel_factor, amount)));
}

bool Input::fly_on(double seconds) {
    if (drag_ != Drag::look || !shown_receiver(state_)) return false;
    const auto held = [&](int key) { return glfwGetKey(state_.window, key) == GLFW_PRESS ? 1.0 : 0.0; };
    const double right = held(GLFW_KEY_D) - held(GLFW_KEY_A), up = held(GLFW_KEY_E) - held(GLFW_KEY_Q),
                 forward = held(GLFW_KEY_W) - held(GLFW_KEY_S);
    if (right == 0 && up == 0 && forward == 0) return false;
    double metres = radii_a_second * state_.status.scene_radius * std::min(seconds, 0.1);
    if (held(GLFW_KEY_LEFT_SHIFT) > 0) metres *= fast;
    if (held(GLFW_KEY_LEFT_CONTROL) > 0) metres *= slow;
    move_camera(state_, fly(state_.pose, metres * right, metres * up, metres * forward));
    return true;
}

}  // namespace etendue
