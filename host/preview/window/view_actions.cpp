#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <algorithm>

#include "host/error.h"
#include "host/image/exr.h"
#include "host/image/outputs.h"
#include "host/image/png.h"
#include "host/open_scene.h"
#include "host/preview/pixel_probe.h"
#include "host/preview/receiver_placement.h"
#include "host/preview/window/view_state.h"

namespace etendue {
namespace {

constexpr uint32_t ray_passes = 16;  // that the ray viewer's paths are of

// The first NAME-001.exr, … that is not there.
std::filesystem::path free_name(const std::filesystem::path& scene) {
    for (int i = 1;; ++i) {
        std::filesystem::path path = fmt::format("{}-{:03}.exr", scene.stem().string(), i);
        if (!std::filesystem::exists(path)) return path;
    }
}

// Owned by a task: says that it has ended, with what it brings, with an error, or without having been run.
class Done {
  public:
    Done(std::shared_ptr<TaskResults> results, bool TaskResults::*what)
        : results_(std::move(results)), what_(what) {}
    Done(const Done&) = delete;
    ~Done() {
        const std::lock_guard lock(results_->mutex);
        (*results_).*what_ = true;
    }

  private:
    std::shared_ptr<TaskResults> results_;
    bool TaskResults::*what_;
};
std::shared_ptr<Done> done_with(const ViewState& state, bool TaskResults::*what) {
    return std::make_shared<Done>(state.results, what);
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

// Meters are shown in false colours, cameras with a tone curve: each as it was left.
static void show_meter(ViewState& state, bool is_new) {
    const PreviewReceiver* receiver = shown_receiver(state);
    const bool is_meter = receiver && !receiver->unit.empty();
    const bool turned = std::exchange(state.shows_meter, is_meter) != is_meter;
    if (turned) std::swap(state.view.curve, state.other_curve), state.fits_scale = true;
    if (!state.picture || state.picture->layer != Layer::radiance ||
        state.view.curve != ToneCurve::false_colors)
        return;
    if (!is_new && !turned) return;
    state.values = value_grid(state.picture->radiance, state.picture->width, state.picture->height);
    if (const auto range = scale_range(state.values); range && state.fits_scale)
        std::tie(state.view.lowest, state.view.highest) = *range;
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
    state.metering.stop();
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
    state.session.post([results = state.results, aspect, index = state.request.receiver,
                        placement = state.pose.placement](PreviewScene& scene) {
        if (index >= scene.scene.receivers.size()) return;
        Receiver receiver = scene.scene.receivers[index];
        receiver.world_from_local = placement;  // the scene's follows when its film begins
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
        Outputs outputs;
        outputs.write([&] { write_exr(path, image); });
        outputs.write([&] { write_png(png, image, float(exposure)); });
        outputs.finish();
        const std::lock_guard lock(results->mutex);
        results->notice = fmt::format("saved {} and {}", path.string(), png.string());
    });
}

std::string rescue_picture(const ViewState& state) {
    if (!state.picture) return "";
    const PreviewPicture& picture = *state.picture;
    Image image;
    image.width = picture.width, image.height = picture.height;
    add_channels(image, {"R", "G", "B"}, {&picture.radiance.front().x, 3 * picture.radiance.size()}, 3);
    image.attributes["scene"] = state.options.scene.string();
    image.attributes["passes"] = double(picture.passes);
    try {
        const std::filesystem::path path = free_name(state.options.scene);
        write_exr(path, image);
        return path.string();
    } catch (const Error&) {
        return "";
    }
}

// One edit is at work at a time, and of those that wait the last counts: a slider may be quicker than the
// scene.
void edit_object(ViewState& state, const ObjectEdit& edit) {
    if (state.edit_is_made) {
        state.edit = edit;
        return;
    }
    state.edit_is_made = true;
    state.session.post([done = done_with(state, &TaskResults::edited), edit](PreviewScene& scene) {
        if (edit.parameter.empty())
            scene.next = scene.live.set_class(edit.object, edit.value.get<std::string>());
        else
            scene.next = scene.live.set_parameter(edit.object, edit.parameter, edit.value);
    });
}

void reload_scene(ViewState& state) {
    state.reload_is_wanted = state.reload_is_made;  // once more after the one at work
    if (state.reload_is_made) return;
    state.reload_is_made = true;
    state.session.post([done = done_with(state, &TaskResults::reloaded), import = state.import](
                           PreviewScene& scene) { scene.next = scene.live.reload(import); });
}

void trace_paths(ViewState& state) {
    RayView& rays = state.rays;
    rays.wanted = rays.is_made;  // once more after those at work
    if (rays.is_made) return;
    rays.is_made = true;
    state.session.post([results = state.results, done = done_with(state, &TaskResults::traced),
                        forward = rays.forward, count = rays.count,
                        filter = rays.filter](PreviewScene& scene) {
        RenderSettings settings;
        settings.width = scene.request.width, settings.height = scene.request.height;
        settings.receiver = scene.receiver;
        settings.seed = scene.request.seed;
        PathRecorder recorder(scene.device, scene.scene, settings, forward);
        // Spread over several passes, which have wavelengths of their own, and over all paths of a pass by
        // steps of the golden ratio (Weyl's sequence).
        std::vector<RecordedPath> paths;
        for (uint32_t pass = 0; pass < ray_passes; ++pass) {
            std::set<uint32_t> indices;
            for (uint32_t i = pass; i < uint32_t(count); i += ray_passes)
                indices.insert(uint32_t(uint64_t(i * 0x9E3779B9u) * recorder.paths_a_pass() >> 32));
            if (indices.empty()) continue;
            const std::vector<uint32_t> list(indices.begin(), indices.end());
            const auto recorded = recorder.record(pass, list);
            paths.insert(paths.end(), recorded.begin(), recorded.end());
        }
        std::erase_if(paths, [&](const RecordedPath& path) { return !filter.keeps(path); });
        const std::lock_guard lock(results->mutex);
        results->paths = std::move(paths);
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
    state.session.post(
        [results = state.results, done = done_with(state, &TaskResults::read), pixel](PreviewScene& scene) {
            const PixelReading reading = read_pixel(scene, pixel);
            const std::lock_guard lock(results->mutex);
            results->reading = reading;
        });
}

namespace {

// True: tasks have brought something.
bool receive_results(ViewState& state) {
    std::optional<std::string> notice, clipboard;
    std::optional<glm::dvec3> point;
    bool news = false;
    {
        const std::lock_guard lock(state.results->mutex);
        TaskResults& results = *state.results;
        news = results.notice || results.clipboard || results.focus || results.reading || results.paths ||
               results.edited || results.traced || results.read || results.reloaded;
        notice = std::exchange(results.notice, {});
        clipboard = std::exchange(results.clipboard, {});
        point = std::exchange(results.focus, {});
        if (results.reading) state.reading = std::exchange(results.reading, {});
        if (results.paths) state.rays.paths = *std::exchange(results.paths, {});
        if (std::exchange(results.read, false)) state.reading_is_made = false;
        if (std::exchange(results.edited, false)) state.edit_is_made = false;
        if (std::exchange(results.traced, false)) state.rays.is_made = false;
        if (std::exchange(results.reloaded, false)) state.reload_is_made = false;
    }
    if (state.rays.wanted && !state.rays.is_made) trace_paths(state);
    if (state.reload_is_wanted && !state.reload_is_made) reload_scene(state);
    if (state.edit && !state.edit_is_made) edit_object(state, *std::exchange(state.edit, {}));
    if (notice) note(state, *notice);
    if (clipboard) glfwSetClipboardString(state.window, clipboard->c_str());
    if (point) {
        state.pose = focus(state.pose, *point);
        note(state, "turning around the point that you chose");
    }
    return news;
}

}  // namespace

bool receive_news(ViewState& state) {
    state.session.rethrow_failure();
    const uint64_t scene_before = state.status.scene, passes_before = state.status.passes;
    const std::string message_before = state.status.message, question_before = state.status.question;
    const auto picture_before = state.picture;
    state.status = state.session.status();
    state.picture = state.session.picture();
    if (state.status.scene != scene_before) {
        if (state.rays.on) trace_paths(state);
        if (scene_before == 0 || state.request.receiver >= state.status.receivers.size())
            state.request.receiver = state.status.first_receiver;
        if (!state.moved) reset_camera(state);
    }
    show_meter(state, state.picture != picture_before);
    if (state.picture && state.picture != picture_before && state.picture->request == state.request)
        if (const auto exposure = state.metering.look(*state.picture, state.view.exposure))
            state.view.exposure = *exposure;
    const bool results = receive_results(state);
    if (!state.reload_is_made && !state.reload_is_wanted) state.import = state.status.import;
    if (state.objects_from != state.status.objects && !state.edit && !state.edit_is_made) {
        state.objects_from = state.status.objects;
        if (state.objects_from) state.objects = *state.objects_from;
    }
    return results || state.picture != picture_before || state.status.scene != scene_before ||
           state.status.passes != passes_before || state.status.message != message_before ||
           state.status.question != question_before;
}

}  // namespace etendue
