#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <algorithm>

#include "host/commands/open_scene.h"
#include "host/error.h"
#include "host/image/exr.h"
#include "host/image/png.h"
#include "host/preview/pixel_probe.h"
#include "host/preview/receiver_placement.h"
#include "host/preview/window/view_state.h"

namespace etendue {
namespace {

// The first NAME-001.exr, … that is not there.
std::filesystem::path free_name(const std::filesystem::path& scene) {
    for (int i = 1;; ++i) {
        std::filesystem::path path = fmt::format("{}-{:03}.exr", scene.stem().string(), i);
        if (!std::filesystem::exists(path)) return path;
    }
}

}  // namespace

const PreviewReceiver* shown_receiver(const ViewState& state) {
    const auto& receivers = state.status.receivers;
    return receivers.empty() ? nullptr
                             : &receivers[std::min<size_t>(state.request.receiver, receivers.size() - 1)];
}

ViewSettings shown_settings(const ViewState& state) {
    if (!state.picture || state.picture->layer == Layer::radiance) return state.view;
    const bool is_error = state.picture->layer == Layer::error;  // relative: from a thousandth to one
    return {0, {}, is_error ? ToneCurve::false_colors : ToneCurve::linear, 0.001, 1};
}

void note(ViewState& state, const std::string& notice) {
    state.notice = notice;
    state.notice_at = glfwGetTime();
}

void move_camera(ViewState& state, const CameraPose& pose) {
    if (!shown_receiver(state)) return;
    state.pose = pose;
    state.moved = true;
    state.moved_at = glfwGetTime();
}

void reset_camera(ViewState& state) {
    const PreviewReceiver* receiver = shown_receiver(state);
    if (!receiver) return;
    state.pose = start_pose(receiver->placement, state.status.scene_center, state.status.scene_radius);
    state.moved = false;
}

void choose_receiver(ViewState& state, uint32_t index) {
    state.request.receiver = index;
    reset_camera(state);
    if (const PreviewReceiver* receiver = shown_receiver(state)) note(state, receiver->name);
}

void meter_exposure(ViewState& state) {
    if (!state.picture) return;
    state.view.exposure = metered_exposure(state.picture->radiance);
    state.metered = true;
}

void focus_at_pointer(ViewState& state) {
    const double x = state.pointer_x / std::max(1u, state.request.width),
                 y = state.pointer_y / std::max(1u, state.request.height);
    state.session.post([results = state.results, x, y](PreviewScene& scene) {
        const SeenPoint seen = see_point(scene, {x, y});
        const std::lock_guard lock(results->mutex);
        if (seen.hit)
            results->focus = glm::dvec3(seen.position);
        else
            results->notice = "nothing is there to turn around";
    });
}

void copy_camera(ViewState& state) {
    const double aspect = double(state.request.width) / std::max(1u, state.request.height);
    state.session.post(
        [results = state.results, aspect, index = state.request.receiver](PreviewScene& scene) {
            const Receiver& receiver = scene.scene.receivers[index];
            const std::string text = camera_as_gltf(receiver, aspect).dump(2);
            const std::lock_guard lock(results->mutex);
            results->clipboard = text;
            results->notice = "the camera is on the clipboard, as glTF";
        });
}

void save_image(ViewState& state) {
    state.session.post([results = state.results, path = free_name(state.options.scene),
                        scene_name = state.options.scene, exposure = state.view.exposure,
                        seed = state.request.seed](PreviewScene& scene) {
        Image image = scene.renderer.develop(true);
        scene.renderer.add_spectra(image);
        image.attributes["scene"] = scene_name.string();
        image.attributes["seed"] = double(seed);
        image.attributes["passes"] = double(scene.renderer.passes());
        image.attributes["algorithm"] = std::string(algorithm_name(scene.renderer.choice().algorithm));
        image.attributes["device"] = scene.device.description.name;
        image.attributes["version"] = std::string(ETENDUE_VERSION);
        std::filesystem::path png = path;
        png.replace_extension(".png");
        write_exr(path, image);
        write_png(png, image, float(exposure));
        const std::lock_guard lock(results->mutex);
        results->notice = fmt::format("saved {} and {}", path.string(), png.string());
    });
}

// One edit is at work at a time, and of those that wait the last counts: a slider may be quicker than the
// scene.
void edit_object(ViewState& state, const ObjectEdit& edit) {
    if (state.edit_is_made) {
        state.edit = edit;
        return;
    }
    state.edit_is_made = true;
    state.session.post([results = state.results, edit](PreviewScene& scene) {
        struct Done {
            TaskResults& results;
            ~Done() {
                const std::lock_guard lock(results.mutex);
                results.edited = true;
            }
        } done{*results};
        if (edit.parameter.empty())
            scene.next = scene.live.set_class(edit.object, edit.value.get<std::string>());
        else
            scene.next = scene.live.set_parameter(edit.object, edit.parameter, edit.value);
    });
}

void read_pixel_at_pointer(ViewState& state) {
    if (!state.picture || state.reading_is_made || state.request.moving) return;
    const glm::uvec2 pixel(std::max(0.0, state.pointer_x), std::max(0.0, state.pointer_y));
    if (pixel.x >= state.request.width || pixel.y >= state.request.height) return;
    const bool grown = state.options.spectral_bins > 0 && state.status.passes > 5 * state.reading_passes / 4;
    if (pixel == state.reading_pixel && state.reading_of == state.picture->request && !grown) return;
    state.reading_pixel = pixel;
    state.reading_of = state.picture->request;
    state.reading_passes = state.status.passes;
    state.reading_is_made = true;
    state.session.post([results = state.results, pixel](PreviewScene& scene) {
        const PixelReading reading = read_pixel(scene, pixel);
        const std::lock_guard lock(results->mutex);
        results->reading = reading;
    });
}

void receive_news(ViewState& state) {
    state.session.rethrow_failure();
    const uint64_t scene_before = state.status.scene;
    state.status = state.session.status();
    state.picture = state.session.picture();
    if (state.status.scene != scene_before) {
        if (scene_before == 0 || state.request.receiver >= state.status.receivers.size())
            state.request.receiver = state.status.first_receiver;
        if (!state.moved) reset_camera(state);
    }
    if (state.picture && !state.metered && state.picture->request == state.request) meter_exposure(state);
    std::optional<std::string> notice, clipboard;
    std::optional<glm::dvec3> point;
    {
        const std::lock_guard lock(state.results->mutex);
        notice = std::exchange(state.results->notice, {});
        clipboard = std::exchange(state.results->clipboard, {});
        point = std::exchange(state.results->focus, {});
        if (state.results->reading) {
            state.reading = std::exchange(state.results->reading, {});
            state.reading_is_made = false;
        }
        if (std::exchange(state.results->edited, false)) state.edit_is_made = false;
    }
    if (state.edit && !state.edit_is_made) edit_object(state, *std::exchange(state.edit, {}));
    if (state.objects_from != state.status.objects && !state.edit && !state.edit_is_made) {
        state.objects_from = state.status.objects;
        if (state.objects_from) state.objects = *state.objects_from;
    }
    if (notice) note(state, *notice);
    if (clipboard) glfwSetClipboardString(state.window, clipboard->c_str());
    if (point) {
        state.pose = focus(state.pose, *point);
        note(state, "turning around the point that you chose");
    }
}

}  // namespace etendue
